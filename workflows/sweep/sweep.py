#!/usr/bin/python3
"""Before and after the runs of a sweep; `make -C workflows sweep` calls it, and rows.mk makes the runs in between.

    sweep.py prepare SCENE SWEEP FOLDER --programs BIN     writes FOLDER/runs.csv and what each run is made of
    sweep.py conclude FOLDER --programs BIN                writes FOLDER/sweep.csv, cost.csv and figures;
                                                           without figures if --no-figures is given

With --factor STATES, where STATES says of which states the factor of safety is wanted (assessment.py), sweep.csv has how
safe each run is. Exit codes: 2 for wrong input; 1 of `conclude` if a run did not end well.
"""

import argparse
import concurrent.futures
import csv
import io
import json
import os
import pathlib
import re
import subprocess
import sys

from assessment import STATES, columns_of, is_assessed
from inputs import content, inputs_of, write_changed
from problems import InputError, problem
from runs import read_runs

# Columns that may differ between runs of the same input; cost.csv has them.
COST = ["wall_seconds", "memory_bytes"]
TABULATED = {"done", "failed", "unbalanced"}
LOST = "fines_lost_percent"


def csv_text(rows):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def read_csv(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


def refuse_foreign(folder, scene, sweep):
    """Throws InputError if another sweep with a table of this name made the runs of the folder."""
    sources = folder / "sources.txt"
    expected = f"{scene}\n{pathlib.Path(sweep).absolute()}\n"
    if sources.is_file() and sources.read_text(encoding="utf-8") != expected:
        found = " and ".join(sources.read_text(encoding="utf-8").splitlines())
        raise InputError([problem(folder, "", f"the runs of {found}", "another NAME=, or no such folder")])
    folder.mkdir(parents=True, exist_ok=True)
    write_changed(sources, expected)


def prepare(options):
    scene = pathlib.Path(options.scene).absolute()
    folder = pathlib.Path(options.folder)
    keys, runs = read_runs(options.sweep)
    refuse_foreign(folder, scene, options.sweep)
    programs = pathlib.Path(options.programs).absolute()
    names = [f"{number:04d}" for number in range(1, len(runs) + 1)]
    write_changed(folder / "runs.csv", csv_text([["run", *keys], *([name, *run] for name, run in zip(names, runs))]))
    for name, run in zip(names, runs):
        changes = [f"{key}={value}" for key, value in zip(keys, run) if value]
        (folder / name).mkdir(exist_ok=True)
        write_changed(folder / name / f"{name}.inputs", inputs_of(scene, programs, changes))
        if options.factor and not (folder / name / f"{name}.status").is_file():
            (folder / name / f"{name}.assessed").unlink(missing_ok=True)
    if options.factor:
        # Its date says since when runs are looked at in this way.
        write_changed(folder / "assess.inputs", f"factor {options.factor}\n{content(programs / 'suffuse-post')}\n")
    # Rows that were removed from the table keep their results, but are not made again.
    for inputs in folder.glob("[0-9]*/*.inputs"):
        if inputs.stem not in names:
            inputs.unlink()


def read_status(folder, name):
    """Word and message of a run."""
    status = folder / name / f"{name}.status"
    inputs = folder / name / f"{name}.inputs"
    stopped = folder / name / f".{name}.messages"
    if status.is_file() and status.stat().st_mtime_ns > inputs.stat().st_mtime_ns:
        word, *lines = status.read_text(encoding="utf-8", errors="replace").splitlines()
    else:
        word, lines = "unfinished", []
        if stopped.is_file():
            lines = stopped.read_text(encoding="utf-8", errors="replace").splitlines()
    messages = [line for line in lines if ": warning: " not in line]
    return word, "" if word == "done" or not messages else messages[0]


def run_tables(folder, names, programs):
    """Columns of `suffuse-post table`, and its row for each run that has one: name -> column -> cell."""
    if not names:
        return [], {}
    table = folder / ".table.csv"
    results = [f"{name}/{name}.results" for name in names]
    command = [programs / "suffuse-post", "table", *results, "--csv", table.name]
    ended = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if ended.returncode == 0:
        header, *rows = read_csv(table)
        table.unlink()
        return header, {row[0]: dict(zip(header, row)) for row in rows}
    if len(names) == 1:
        print(f"{names[0]}: no row in the table: {ended.stderr.strip()}", file=sys.stderr)
        return [], {}
    # One unreadable run must not hide the others.
    columns, found = [], {}
    for name in names:
        header, row = run_tables(folder, [name], programs)
        columns = columns or header
        found |= row
    return columns, found


def write_tables(folder, programs, factor):
    """Returns the keys, and the rows of sweep.csv as dictionaries."""
    header, *runs = read_csv(folder / "runs.csv")
    keys = header[1:]
    ends = {run[0]: read_status(folder, run[0]) for run in runs}
    columns, values = run_tables(folder, [name for name, (word, _) in ends.items() if word in TABULATED], programs)
    columns = [column for column in columns if column not in {"run", "status", *COST, *keys}]
    rows = []
    costs = []
    for name, *cells in runs:
        word, message = ends[name]
        row = values.get(name, {}) | dict(zip(header, [name, *cells])) | {"status": word, "message": message}
        rows.append(row)
        if factor:
            safety = columns_of(folder, name)
            row |= safety
            columns += [column for column in safety if column not in columns]
        costs.append([name, *costs_of(folder / name / f"{name}.results" / "run.json" if word in TABULATED else None)])
    order = [*header, "status", "message", *columns]
    write_changed(folder / "sweep.csv", csv_text([order, *([row.get(column, "") for column in order] for row in rows)]))
    write_changed(folder / "cost.csv", csv_text([["run", *COST], *costs]))
    return keys, rows


def costs_of(run_json):
    if not run_json or not run_json.is_file():
        return [""] * len(COST)
    info = json.loads(run_json.read_text(encoding="utf-8"))
    return [info.get(name, "") for name in COST]


def numbers(rows, column):
    try:
        return {float(row[column]) for row in rows if row.get(column)}
    except ValueError:
        return set()


def figures(folder, keys, rows):
    """Names of the figures and what they show: arguments of `suffuse-post sweep`."""
    done = [row for row in rows if row["status"] == "done"]
    quantity = LOST if numbers(done, LOST) else "water_out"
    if not done:
        return {}
    found = {"over-time": ["--over-time", "fines_out"], "distribution": ["--y", quantity]}
    for key in keys:
        if len(numbers(done, key)) > 1:
            found["over-" + re.sub(r"[^\w.-]+", "-", key).strip("-")] = ["--x", key, "--y", quantity]
    return found


def draw(folder, keys, rows, programs):
    """Draws the figures that are missing or older than the table. Returns messages."""
    post = programs / "suffuse-post"
    wanted = figures(folder, keys, rows)
    made = max((folder / "sweep.csv").stat().st_mtime_ns, post.stat().st_mtime_ns)

    def draw_one(name):
        picture = folder / f"{name}.png"
        if picture.is_file() and picture.stat().st_mtime_ns > made:
            return ""
        command = [post, "sweep", "sweep.csv", *wanted[name], "-o", picture.name]
        return subprocess.run(command, cwd=folder, capture_output=True, text=True).stderr.strip()

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return [message for message in pool.map(draw_one, wanted) if message]


def conclude(options):
    folder = pathlib.Path(options.folder)
    programs = pathlib.Path(options.programs).absolute()
    keys, rows = write_tables(folder, programs, options.factor)
    messages = draw(folder, keys, rows, programs) if options.figures else []
    bad = [row for row in rows if row["status"] != "done"]
    if options.factor:
        bad += [row | {"status": "not assessed", "message": "call make again"} for row in rows
                if row["status"] == "done" and not is_assessed(folder, row["run"])]
    messages += [f"{row['run']} {row['status']}: {row['message'] or 'not made'}" for row in bad[:10]]
    if len(bad) > 10:
        messages.append(f"... and {len(bad) - 10} more: see the columns status and message")
    for message in messages:
        print(message, file=sys.stderr)
    print(f"{len(rows) - len(bad)} of {len(rows)} runs are done; {'table and figures are' if options.figures else 'their table is'} in {folder.resolve()}")
    return 1 if bad else 0


def main():
    parser = argparse.ArgumentParser(description="Before and after the runs of a sweep.")
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("prepare")
    command.add_argument("scene", metavar="SCENE")
    command.add_argument("sweep", metavar="SWEEP")
    for command in [command, commands.add_parser("conclude")]:
        command.add_argument("folder", metavar="FOLDER")
        command.add_argument("--programs", required=True, metavar="FOLDER")
        command.add_argument("--factor", choices=STATES)
    commands.choices["conclude"].add_argument("--no-figures", dest="figures", action="store_false")
    options = parser.parse_args()
    try:
        sys.exit(prepare(options) if options.command == "prepare" else conclude(options))
    except InputError as error:
        print("\n".join(f"sweep.py: {line}" for line in str(error).splitlines()), file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()

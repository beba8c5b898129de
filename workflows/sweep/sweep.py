#!/usr/bin/python3
"""A sweep from its table to its figures, in OUT/sweep/NAME/. make calls it, with its variables in the environment and itself as
MAKE; its -j holds for the runs, which rows.mk makes.

Writes runs.csv, what each run is made of, sweep.csv, cost.csv and figures. With SWEEP_FOLDER the sweep is in that folder and has no
figures. With FACTOR=1 it looks at how safe the last state of each run is; FACTOR=all, start and checks: run.py. REGION and
DEEPER leave soil out. Exit codes: 2 for wrong input; 1 if a run did not end well.
"""

import concurrent.futures
import os
import pathlib
import shlex
import subprocess
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(1, str(here.parent))
from assessment import columns_of, is_assessed, reduction_options
from common import (csv_text, end_with, file_name, find_file, folder_of, programs_of, read, read_csv, read_scene, run_json, write_changed,
                    wrong)
from inputs import content, inputs_of
from runs import read_runs

# Columns that may differ between runs of the same input; cost.csv has them.
COST = ["wall_seconds", "memory_bytes"]
TABULATED = {"done", "failed", "unbalanced"}
LOST = "fines_lost_percent"


def refuse_foreign(folder, scene, sweep):
    """Throws InputError if another sweep with a table of this name made the runs of the folder."""
    sources = folder / "sources.txt"
    expected = f"{scene}\n{pathlib.Path(sweep).absolute()}\n"
    if sources.is_file() and read(sources) != expected:
        found = " and ".join(read(sources).splitlines())
        raise wrong(folder, "", f"the runs of {found}", "another NAME=, or no such folder")
    folder.mkdir(parents=True, exist_ok=True)
    write_changed(sources, expected)


def prepare(scene, sweep, folder, programs, states):
    keys, runs = read_runs(sweep)
    refuse_foreign(folder, scene, sweep)
    names = [f"{number:04d}" for number in range(1, len(runs) + 1)]
    write_changed(folder / "runs.csv", csv_text([["run", *keys], *([name, *run] for name, run in zip(names, runs))]))
    for name, run in zip(names, runs):
        changes = [f"{key}={value}" for key, value in zip(keys, run) if value]
        (folder / name).mkdir(exist_ok=True)
        write_changed(folder / name / f"{name}.inputs", inputs_of(scene, programs, changes))
        if states and not (folder / name / f"{name}.status").is_file():
            (folder / name / f"{name}.assessed").unlink(missing_ok=True)
    if states:
        # Its date says since when runs are looked at in this way.
        write_changed(folder / "assess.inputs", f"factor {' '.join(states)}\n{content(programs / 'suffuse-post')}\n")
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
        word, *lines = read(status).splitlines()
    else:
        word, lines = "unfinished", read(stopped).splitlines() if stopped.is_file() else []
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


def write_tables(folder, programs, states):
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
        if states:
            safety = columns_of(folder, name)
            row |= safety
            columns += [column for column in safety if column not in columns]
        costs.append([name, *costs_of(folder / name / f"{name}.results" if word in TABULATED else None)])
    order = [*header, "status", "message", *columns]
    write_changed(folder / "sweep.csv", csv_text([order, *([row.get(column, "") for column in order] for row in rows)]))
    write_changed(folder / "cost.csv", csv_text([["run", *COST], *costs]))
    return keys, rows


def costs_of(results):
    info = run_json(results) if results and (results / "run.json").is_file() else {}
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
            found[f"over-{file_name(key)}"] = ["--x", key, "--y", quantity]
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


def conclude(folder, programs, states, with_figures):
    keys, rows = write_tables(folder, programs, states)
    messages = draw(folder, keys, rows, programs) if with_figures else []
    bad = [row for row in rows if row["status"] != "done"]
    if states:
        bad += [row | {"status": "not assessed", "message": "call make again"} for row in rows
                if row["status"] == "done" and not is_assessed(folder, row["run"])]
    messages += [f"{row['run']} {row['status']}: {row['message'] or 'not made'}" for row in bad[:10]]
    if len(bad) > 10:
        messages.append(f"... and {len(bad) - 10} more: see the columns status and message")
    for message in messages:
        print(message, file=sys.stderr)
    print(f"{len(rows) - len(bad)} of {len(rows)} runs are done; {'table and figures are' if with_figures else 'their table is'} in {folder.resolve()}")
    return 1 if bad else 0


def make(scene, table, folder, states="", with_figures=False, with_reduction=True):
    """Makes the sweep of a table. `states`: of which states the factor of safety is wanted (run.py); "" for none. REGION, DEEPER
    and QUADRATIC count `with_reduction`. Returns 1 if a run did not end well. Cases without runs, of the states `case`, have no table."""
    programs, arguments = programs_of(), [states] if states else []
    if with_reduction and any(os.environ.get(variable) for variable in ("REGION", "DEEPER", "QUADRATIC")):
        arguments += reduction_options(read_scene(scene), read_runs(table)[0], states)
    prepare(scene, table, folder, programs, arguments)
    variables = {"PROGRAMS": str(programs), "STATES": " ".join(arguments), "RUN": str(here / "run.py")}
    sys.stdout.flush()
    # The command of make may have arguments. make's job slots are open files. A run that was stopped or killed does not stop the others.
    subprocess.run([*shlex.split(os.environ["MAKE"]), "-k", "-C", folder, "-f", here / "rows.mk"], env=os.environ | variables, close_fds=False)
    return 0 if states == "case" else conclude(folder, programs, states, with_figures)


def main():
    if not os.environ.get("SCENE") and not os.environ.get("SWEEP"):
        os.environ |= {"SCENE": "examples/weir/weir.toml", "SWEEP": "sweep/weir.csv"}
    scene, table = find_file("SCENE"), find_file("SWEEP")
    factor = os.environ.get("FACTOR", "")
    states = {"0": "", "1": "last"}.get(factor, factor)
    if states not in ("", "last", "all", "start", "checks"):
        raise wrong("FACTOR", "", f"'{factor}'", "1, all, start or checks")
    folder = os.environ.get("SWEEP_FOLDER")
    return make(scene, table, pathlib.Path(folder) if folder else folder_of("sweep", table), states, not folder)


if __name__ == "__main__":
    end_with("", main)

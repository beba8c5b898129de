#!/usr/bin/python3
"""Is anything lost when runs are killed? Kills runs at random moments, several times in a row, resumes each until it is done,
and compares every file with that of an undisturbed run.

    kill.py PROGRAMS FOLDER KILLS

PROGRAMS is the folder of the three programs. Writes FOLDER/kill.csv, a line per formulation and scheme, and prints it as a
table. Fails if a snapshot that a series names cannot be read, if a run does not go on, or if its files differ at the end; such a
run stays in FOLDER. SEED=N: other moments.
"""

import filecmp
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(1, str(here.parent))
from common import call, csv_text, empty_folder, markdown, set_options, timed

# A column that a load squeezes by half an element while its fines erode.
MOVING = ["time={end=4.0,tolerance=2e-3}", 'soil.specimen.skeleton={law="elastic",young=3e5,poisson=0.2}',
          'boundary[0]={on="top",pressure=[[0.0,2e3],[2.0,6e3]],concentration=0.01,traction=[[0.0,0.0,-2e3],[2.0,0.0,-3e4]]}',
          'boundary[1]={on="bottom",pressure=0.0,concentration=0.0,fix="both"}',
          'boundary[2]={on="left",fix="normal"}', 'boundary[3]={on="right",fix="normal"}']
SCALED = 'time={end=4.0,scheme="explicit",mass_scaling=100.0}'
DOUBLE = ["formulation=double-point", "points.liquid_per_element=3"]
# Formulation, scheme and keys. Runs of half a second with forty snapshots, so that a snapshot is often being written.
MODES = {
    "sp-explicit": ("single-point", "explicit", ['time={end=0.4,scheme="explicit"}', "output.every=0.01"]),
    "sp-implicit": ("single-point", "implicit", ["time={end=4.0,tolerance=2e-4}"]),
    "sp-moving": ("single-point", "implicit with soil that moves", MOVING),
    "sp-failing": ("single-point", "implicit with soil that fails", []),
    "dp-explicit": ("double-point", "explicit", [SCALED, *DOUBLE]),
    "dp-implicit": ("double-point", "implicit", ["time={end=4.0,step=0.02}", *DOUBLE]),
    "dp-points": ("double-point", "explicit at material points", [SCALED, "flow.integration=material-point", *DOUBLE]),
    "dp-moving": ("double-point", "implicit with soil that moves", [*MOVING, *DOUBLE]),
}
# Facts that differ between any two runs.
OF_RUN = {"wall_seconds", "seconds", "memory_bytes", "threads", "resumed_at"}


def account(value):
    """The facts of a run in run.json that any two runs share."""
    if isinstance(value, dict):
        return {key: account(part) for key, part in value.items() if key not in OF_RUN}
    return [account(part) for part in value] if isinstance(value, list) else value


def differences(results, whole):
    """Names of the files that differ, or that one of the two has not."""
    names = {str(file.relative_to(folder)) for folder in (results, whole) for file in folder.rglob("*")
             if file.is_file() and file.name not in (".lock", "run.json")}
    _, differing, missing = filecmp.cmpfiles(results, whole, names, shallow=False)
    one, other = (account(json.loads((folder / "run.json").read_text(encoding="utf-8"))) for folder in (results, whole))
    return [*differing, *missing, *["run.json"] * (one != other)]


def cannot_be_read(post, results, folder):
    """What is said of snapshots that the series name, and of tables; nothing if all can be read."""
    if not (results / "mesh.hdf.series").exists():
        return ""
    for command in (["export", results, "-o", folder / "exported"], ["history", results], ["ledger", results]):
        ended = subprocess.run([post, *command], capture_output=True, text=True)
        if ended.returncode:
            return ended.stdout + ended.stderr
    return ""


def disturb(programs, folder, mode, wanted, generator):
    """The row of kill.csv."""
    formulation, scheme, changes = MODES[mode]
    solver, case, whole = programs / "suffuse-solver", folder / "kill.case.h5", folder / "whole"
    empty_folder(folder)
    scene = here / ("kill-bank.toml" if mode == "sp-failing" else "kill.toml")
    call(programs / "suffuse-mesher", scene, *set_options(changes), "-o", case)
    duration, _ = timed(solver, case, "-o", whole, "--quiet", cwd=folder)
    kills = unreadable = runs = resumed = equal = 0
    while kills < wanted:
        runs += 1
        results = folder / f"run-{runs}"
        for _ in range(min(generator.randint(1, 4), wanted - kills)):
            run = subprocess.Popen([solver, case, "-o", results, "--quiet", "--resume", "--threads", str(generator.randint(1, 2)),
                                    "--checkpoint-every", generator.choice(["0.05", "1.05"])], stderr=subprocess.PIPE, text=True, cwd=folder)
            time.sleep(generator.random() * duration)
            run.kill()
            said = run.communicate()[1]
            if run.returncode == 0:  # too late: it is done
                break
            if run.returncode != -signal.SIGKILL:
                sys.exit(f"{mode}: {results.name}: did not go on (exit code {run.returncode}):\n{said}")
            kills += 1
            said = cannot_be_read(programs / "suffuse-post", results, folder)
            unreadable += bool(said)
            sys.stderr.write(said)
        ended = subprocess.run([solver, case, "-o", results, "--quiet", "--resume"], capture_output=True, text=True, cwd=folder)
        resumed += ended.returncode == 0
        sys.stderr.write(ended.stderr if ended.returncode else "")
        found = differences(results, whole)
        equal += not found
        if found:
            print(f"{results} is not as {whole}: {', '.join(found)}", file=sys.stderr)
        else:
            shutil.rmtree(results)
    shutil.rmtree(folder / "exported", ignore_errors=True)
    return [formulation, scheme, f"{duration:.3g}", kills, unreadable, runs, resumed, equal]


def main(programs, folder, kills):
    programs, folder = pathlib.Path(programs).resolve(), pathlib.Path(folder).resolve()
    generator = random.Random(int(os.environ.get("SEED", "1")))
    # The shares of all modes add up to KILLS.
    ends = [int(kills) * place // len(MODES) for place in range(len(MODES) + 1)]
    rows = [disturb(programs, folder / mode, mode, end - start, generator) for mode, start, end in zip(MODES, ends, ends[1:])]
    header = ["formulation", "scheme", "run_seconds", "kills", "unreadable", "runs", "clean_resumes", "equal_ends"]
    (folder / "kill.csv").write_text(csv_text([header, *rows]), encoding="utf-8")
    lines = [row[:2] + row[3:] for row in rows]
    lines.append(["all", "", *(sum(column) for column in list(zip(*lines))[2:])])
    print(markdown(["formulation", "scheme", "kills", "of these with a snapshot that cannot be read", "runs", "that went on to the end",
                    "with equal files"], lines, range(7)), end="")
    return 0 if all(unreadable == 0 and resumed == equal == runs for *_, unreadable, runs, resumed, equal in rows) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

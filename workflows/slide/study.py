#!/usr/bin/python3
"""When the levee fails.

    study.py factors SOLVER STEM          prints the factor of safety through the flood, as CSV
    study.py fall RESULTS                 prints the range of times, s, of the failure in which the soil moves most
    study.py moments PROGRAMS FOLDER      prints by mesh and tolerance, as CSV, when it has moved by 5 cm, when it loses its equilibrium,
                                          and when its factor with quadratic displacements falls to 1
"""

import csv
import math
import pathlib
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(1, str(here.parent))
from common import call, read_rows, run_json, set_options


def factor(solver, stem, time, *options):
    """The table row of the factor of safety of a state; None if it has none."""
    said = call(solver, f"{stem}.case.h5", "--strength-reduction", "--state", f"{stem}.results", "--time", time, *options, ok=(0, 3)).stdout
    rows = list(csv.DictReader(said.splitlines()))
    return rows[0] if rows else None


def factors(solver, stem):
    print("t,factor,quadratic,fines_left")
    for time in range(0, 17501, 2500):
        linear, quadratic = factor(solver, stem, time), factor(solver, stem, time, "--quadratic")
        if linear and quadratic:
            print(time, linear["factor"], quadratic["factor"], linear["fines_left"], sep=",", flush=True)


def fall_to_one(solver, stem, step):
    """The time, s, at which the factor with quadratic displacements falls to 1, between snapshots every so many seconds."""
    def excess(time):
        row = factor(solver, stem, time, "--quadratic")
        return math.log(float(row["factor"])) if row else -1.0
    low, high = 0, int(float(read_rows(f"{stem}.results/history.csv")[-1]["t"])) // step
    above, below = 1.0, -1.0
    while high - low > 1:
        middle = (low + high) // 2
        found = excess(middle * step)
        if found > 0:
            low, above = middle, found
        else:
            high, below = middle, found
    return round((low + above / (above - below)) * step)


def time_of(displacement, results):
    """When the largest displacement, m, passes a value, s, between rows of the history; empty if it does not."""
    before = None
    for row in read_rows(f"{results}/history.csv"):
        time, moved = float(row["t"]), float(row["displacement_max"])
        if moved >= displacement:
            return round(before[0] + (displacement - before[1]) / (moved - before[1]) * (time - before[0]))
        before = time, moved
    return ""


def fall(results):
    moved = {}  # least and largest displacement after each failure, m
    for row in read_rows(f"{results}/history.csv"):
        failed, displacement = float(row["failure_time"]), float(row["displacement_max"])
        if failed > 0 and float(row["inertia"]) > 0:
            least, most = moved.get(failed, (displacement, displacement))
            moved[failed] = (min(least, displacement), max(most, displacement))
    if not moved:
        sys.exit(f"{results}: nothing has failed")
    first = int(max(moved, key=lambda failed: moved[failed][1] - moved[failed][0]))
    print(f"{first}:{first + 4}")


def moments(programs, folder):
    print("size,tolerance,elements,steps,wall_seconds,moved_by_5_cm,failure_time,factor_falls_to_1", flush=True)
    for size, tolerance in (("1", "1e-3"), ("0.7", "1e-3"), ("0.5", "1e-3"), ("0.35", "1e-3"), ("0.25", "1e-3"), ("0.5", "1e-2"), ("0.5", "3e-4")):
        stem = f"{folder}/size-{size}-tolerance-{tolerance}"
        keys = ["name=slide", f"mesh.size={size}", f"time.tolerance={tolerance}", "time.failure=stop", "time.end=40000.0",
                "output={every=500.0,snapshot_every=500.0}"]
        call(f"{programs}/suffuse-mesher", here.parent / "examples/slide/slide.toml", "-o", f"{stem}.case.h5", *set_options(keys))
        # The run ends when the soil has lost its equilibrium; otherwise the time stays empty.
        code = call(f"{programs}/suffuse-solver", f"{stem}.case.h5", "-o", f"{stem}.results", "--force", "--quiet", ok=(0, 3)).returncode
        failed = read_rows(f"{stem}.results/history.csv")[-1]["t"] if code else ""
        run = run_json(f"{stem}.results")
        fell = fall_to_one(f"{programs}/suffuse-solver", stem, 500)
        print(size, tolerance, run["elements"], run["steps"], run["wall_seconds"], time_of(0.05, f"{stem}.results"), failed, fell, sep=",", flush=True)


if __name__ == "__main__":
    {"factors": factors, "fall": fall, "moments": moments}[sys.argv[1]](*sys.argv[2:])

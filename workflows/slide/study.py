#!/usr/bin/python3
"""When the levee fails.

    study.py factors SOLVER STEM          prints the factor of safety through the flood, as CSV
    study.py fall RESULTS                 prints the range of times, s, in which the soil falls after it first fails
    study.py moments PROGRAMS FOLDER      prints the moment at which it loses its equilibrium, by mesh and tolerance, as CSV
"""

import pathlib
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(1, str(here.parent))
from common import call, read_rows, run_json, set_options


def factors(solver, stem):
    lines = []
    for time in range(0, 20001, 2500):
        said = call(solver, f"{stem}.case.h5", "--strength-reduction", "--state", f"{stem}.results", "--time", time, ok=(0, 3)).stdout.splitlines()
        if said:  # there are states without a factor
            lines += [said[-1]] if lines else [said[0], said[-1]]
    print("\n".join(lines))


def fall(results):
    failed = next((int(float(row["failure_time"])) for row in read_rows(f"{results}/history.csv") if float(row["failure_time"]) > 0), 0)
    if not failed:
        sys.exit(f"{results}: nothing has failed")
    print(f"{failed}:{failed + 4}")


def moments(programs, folder):
    print("size,tolerance,elements,steps,wall_seconds,failure_time", flush=True)
    for size, tolerance in (("0.7", "1e-3"), ("0.5", "1e-3"), ("0.35", "1e-3"), ("0.25", "1e-3"), ("0.5", "1e-2"), ("0.5", "3e-4")):
        stem = f"{folder}/size-{size}-tolerance-{tolerance}"
        keys = ["name=slide", f"mesh.size={size}", f"time.tolerance={tolerance}", "time.failure=stop", "time.end=40000.0", "output={every=500.0}"]
        call(f"{programs}/suffuse-mesher", here.parent / "examples/slide/slide.toml", "-o", f"{stem}.case.h5", *set_options(keys))
        # The run ends when the soil has lost its equilibrium; otherwise the time stays empty.
        code = call(f"{programs}/suffuse-solver", f"{stem}.case.h5", "-o", f"{stem}.results", "--force", "--quiet", ok=(0, 3)).returncode
        failed = read_rows(f"{stem}.results/history.csv")[-1]["t"] if code else ""
        run = run_json(f"{stem}.results")
        print(size, tolerance, run["elements"], run["steps"], run["wall_seconds"], failed, sep=",", flush=True)


if __name__ == "__main__":
    {"factors": factors, "fall": fall, "moments": moments}[sys.argv[1]](*sys.argv[2:])

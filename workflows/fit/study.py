#!/usr/bin/python3
"""Do the intervals of a calibration hold the true values as often as they say? `make -C workflows fit-study`.

    study.py FOLDER --programs BIN [--seeds 20] [--points FILE.csv]

Computes column.toml with known values, adds normal noise of a known deviation, and fits again, with a seed each.
Writes FOLDER/study.csv. Exit code 1 unless each key is within 3 standard errors for each seed, and within its 95 %
interval for 17 of 20. --points writes the points of the first seed, with those of four keys, and makes no fit.
"""

import argparse
import pathlib
import random
import sys

import numpy

here = pathlib.Path(__file__).resolve().parent
sys.path[1:1] = [str(here.parent), str(here.parent / "sweep"), str(here.parent / "convergence")]
from common import csv_text, write_changed
from fit import Fit, calibrate
from keys import Key, read_keys
from measured import DEVIATION, Measured, computed
from trials import Trials

SCENE = here / "column.toml"
TRUE = {"soil.sand.erosion.rate": "0.0002", "soil.sand.erosion.threshold": "0.6", "soil.silt.erosion.rate": "2e-06"}
# In the points of the example, which has a fourth key.
TRUE_OF_POINTS = TRUE | {"soil.silt.erosion.threshold": "10.0"}
DEVIATIONS = {"history.flux_out": 1e-6, "probe[0].pressure": 30.0, "ledger.fines_out": 5e-3}
TIMES = range(300, 3601, 300)
LEAST_SHARE = 17 / 20
OFF = 1.1  # starts over true values


def exact_points(folder, programs, true):
    trials = Trials(SCENE, list(true), folder, programs)
    (row,) = trials.run([tuple(true.values())])
    points = [(0, name, float(t), 0.0, deviation) for name, deviation in DEVIATIONS.items() for t in TIMES]
    measured = Measured(SCENE, list(DEVIATIONS), points)
    measured.value = computed(measured, trials.results(row))
    return measured


def noisy(exact, seed):
    generator = random.Random(seed)
    values = [generator.gauss(value, deviation) for value, deviation in zip(exact.value, exact.deviation)]
    return Measured(exact.path, exact.outputs, list(zip(exact.lines, exact.names, exact.t, values, exact.deviation)))


def write_points(path, measured):
    rows = [[f"{t}", *(f"{cell:.4g}" for _, at in measured.parts() for k in at if measured.t[k] == t
                       for cell in (measured.value[k], measured.deviation[k]))] for t in TIMES]
    header = ["t", *(column for name in measured.outputs for column in (name, f"{name}.{DEVIATION}"))]
    write_changed(path, csv_text([header, *rows]))


def study(folder, programs, seeds):
    # The search starts near its end, which saves half of the runs; all seeds share the first of them.
    keys = [Key(key.name, OFF * float(TRUE[key.name]), key.low, key.high, key.unit) for key in read_keys(",".join(TRUE), SCENE, programs)[0]]
    exact = exact_points(folder, programs, TRUE)
    rows = []
    for seed in range(1, seeds + 1):
        fit = Fit(keys, noisy(exact, seed), Trials(SCENE, list(TRUE), folder, programs))
        found, known, _ = calibrate(fit)
        for j, key in enumerate(keys):
            error = known.error[j]
            # In standard errors of x, in which the interval is symmetric.
            off = (found.x[j] - key.x_of(float(TRUE[key.name]))) / error
            within = [bool(numpy.abs(off) <= known.quantile), bool(numpy.abs(off) <= 3.0)]
            rows.append([seed, key.name, TRUE[key.name], *fit.texts(found.x)[j : j + 1], f"{key.slope_at(float(TRUE[key.name])) * error:.4g}",
                         f"{off:.4f}", *("yes" if inside else "no" for inside in within)])
        print(f"seed {seed}, in standard errors: " + ", ".join(f"{row[1]} off by {row[5]}" for row in rows[-len(keys):]), flush=True)
    write_changed(folder / "study.csv", csv_text([["seed", "key", "true", "value", "standard_error", "errors_off", "within_95", "within_3_errors"], *rows]))
    failed = False
    for key in keys:
        of_key = [row for row in rows if row[1] == key.name]
        within_95, within_3 = (sum(row[k] == "yes" for row in of_key) for k in (6, 7))
        offs = numpy.array([float(row[5]) for row in of_key])
        print(f"{key.name}: within 95 % for {within_95} of {seeds} seeds, within 3 standard errors for {within_3}; "
              f"in standard errors the mean is {offs.mean():.2f}, the root mean square {numpy.sqrt(numpy.mean(offs**2)):.2f}")
        failed |= within_3 < seeds or within_95 < LEAST_SHARE * seeds
    return failed


def main():
    parser = argparse.ArgumentParser(description="Calibrations of known values.")
    parser.add_argument("folder", metavar="FOLDER")
    parser.add_argument("--programs", required=True, metavar="BIN")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--points", metavar="FILE.csv")
    options = parser.parse_args()
    folder, programs = pathlib.Path(options.folder).absolute(), pathlib.Path(options.programs).absolute()
    if options.points:
        write_points(pathlib.Path(options.points), noisy(exact_points(folder.with_name(folder.name + ".points"), programs, TRUE_OF_POINTS), 1))
        return 0
    return 1 if study(folder, programs, options.seeds) else 0


if __name__ == "__main__":
    sys.exit(main())

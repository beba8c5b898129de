#!/usr/bin/env python3
"""Fits the rate and the residual of an erosion law to one seepage test, and predicts another with them.

    fit.py SCENE --measured FILE --gradients FILE --fit RUN --programs FOLDER --out FOLDER [--set KEY=VALUE ...]

SCENE is a column without gravity whose first boundary has a pressure and whose second has none. A run is a
test: its gradients become that pressure. Needs Python 3.11 and SciPy. Writes search.csv, fit.csv and the
results of every run, RUN.results. Exit code 2: a table or the scene is wrong; 1: a program failed.
"""

import argparse
import math
import os
import pathlib
import shutil
import sys
import tempfile

import numpy
from scipy.optimize import least_squares

workflows = pathlib.Path(__file__).resolve().parent.parent
sys.path[1:1] = [str(workflows), str(workflows / "sweep")]
from common import InputError, consult, csv_text, end_with, number_of, read_rows, read_scene, set_options, wrong
from runs import lines_of

UNIT_WEIGHT = 9810.0  # of water, N/m3
RAISING = 60.0  # s that it takes to go from one gradient to the next


# --- Tables --------------------------------------------------------------------------------------------


def read_table(path, bounds):
    """Rows as (line, run, values by column); `bounds` has the smallest and largest value of each column."""
    columns = ["run", *bounds]
    (line, names), *rows = lines_of(path, ",".join(columns))
    if names != columns:
        raise wrong(f"{path}:{line}", "", f"the columns {','.join(names)}", ",".join(columns))
    if not rows:
        raise wrong(path, "", "no row", "at least one")
    return [read_row(f"{path}:{line}", cells, bounds) for line, cells in rows]


def read_row(place, cells, bounds):
    if len(cells) != len(bounds) + 1:
        raise wrong(place, "", f"{len(cells)} cells", str(len(bounds) + 1))
    values = {column: number_of(text) for column, text in zip(bounds, cells[1:])}
    for (column, (low, high)), text in zip(bounds.items(), cells[1:]):
        if values[column] is None or not low <= values[column] <= high:
            raise wrong(place, column, f"'{text}'", f"a number from {low:g} to {high:g}")
    if not cells[0] or not cells[0].replace("-", "").replace("_", "").isalnum():
        raise wrong(place, "run", f"'{cells[0]}'", "letters, digits, - or _")
    return place, cells[0], values


def read_runs(path, time, bounds):
    """The rows of each run. Times ascend."""
    runs = {}
    for place, name, values in read_table(path, {time: (0.0, math.inf), **bounds}):
        rows = runs.setdefault(name, [])
        if values[time] <= (rows[-1][time] if rows else 0.0):
            raise wrong(place, time, f"{values[time]:g}", "times above 0 that ascend within a run")
        rows.append(values)
    return runs


def read_tests(options):
    """What was measured and what was applied, by run; checks that they fit together."""
    measured = read_runs(options.measured, "hours", {"fines_lost": (0.0, 100.0), "conductance": (0.0, math.inf)})
    gradients = read_runs(options.gradients, "until_hours", {"gradient": (0.0, math.inf)})
    for name, points in measured.items():
        if name not in gradients:
            raise InputError([f"{options.gradients}: got no row of '{name}', which {options.measured} has"])
        end = gradients[name][-1]["until_hours"]
        if points[-1]["hours"] > end:
            raise wrong(options.measured, name, f"a point at {points[-1]['hours']:g} h", f"none after {end:g} h, where its gradients end")
    if options.fit not in measured:
        raise wrong("--fit", "", f"'{options.fit}'", f"one of {', '.join(measured)}")
    if len(measured[options.fit]) < 2:
        raise InputError([f"{options.measured}: got one point of '{options.fit}'; two parameters cannot be fitted to fewer than two points"])
    return measured, gradients


# --- Runs ----------------------------------------------------------------------------------------------


class Specimen:
    """What the search must know of the scene."""

    def __init__(self, path):
        self.path, scene = path, read_scene(path)
        try:
            (self.soil, soil), = scene["soil"].items()
            self.height = float(scene["geometry"]["height"])
            self.fines = 1.0 - soil["porosity"] - soil["skeleton_fraction"]
            self.rate = float(soil["erosion"]["rate"])
        except (KeyError, TypeError, ValueError) as error:
            raise InputError([f"{path}: expected a column of one soil with porosity, skeleton_fraction and erosion.rate as numbers; {error!r}"]) from error
        if not self.rate > 0.0 or not self.fines > 0.0:
            raise InputError([f"{path}: expected a rate and fines above 0"])


def pressures(stages, height):
    """The pressure above the specimen, as pairs of time and value for --set."""
    pairs, start = [], 0.0
    for stage in stages:
        value = UNIT_WEIGHT * height * stage["gradient"]
        end = 3600.0 * stage["until_hours"]
        pairs += [[start + RAISING if pairs else 0.0, value], [end, value]]
        start = end
    return "[" + ",".join(f"[{t:.17g},{p:.17g}]" for t, p in pairs) + "]"


class Runner:
    """Runs the programs."""

    def __init__(self, specimen, programs, changes):
        self.specimen = specimen
        self.programs = pathlib.Path(programs)
        self.changes = changes
        self.runs = 0

    def run(self, name, stages, end, rate, residual, folder):
        """Computes a test up to `end`, h; returns its results folder."""
        erosion = f"soil.{self.specimen.soil}.erosion"
        changes = [*self.changes, f"name={name}", f"{erosion}.rate={rate:.17g}", f"{erosion}.residual={residual:.17g}",
                   f"boundary[0].pressure={pressures(stages, self.specimen.height)}", f"time.end={3600.0 * end:.17g}"]
        case, results = folder / f"{name}.case.h5", folder / f"{name}.results"
        shutil.rmtree(results, ignore_errors=True)
        consult(self.programs / "suffuse-mesher", self.specimen.path, *set_options(changes), "-o", case)
        consult(self.programs / "suffuse-solver", case, "-o", results, env=os.environ | {"OMP_NUM_THREADS": "1"})
        self.runs += 1
        return results


def fines_lost(results, hours):
    """Per cent of the fines that have left at these hours, by the ledger."""
    rows = [{name: float(text) for name, text in row.items()} for row in read_rows(results / "ledger.csv")]
    lost = [100.0 * (row["fines_out"] - row["fines_in"]) / rows[0]["erodible"] for row in rows]
    return numpy.interp([3600.0 * h for h in hours], [row["t"] for row in rows], lost)


# --- The fit -------------------------------------------------------------------------------------------


def search(runner, name, points, stages, out):
    """Least squares over the logarithm of the rate and the share of the fines that stays."""
    specimen = runner.specimen
    hours = [point["hours"] for point in points]
    measured = numpy.array([point["fines_lost"] for point in points])
    trials = []

    def difference(x):
        rate, residual = specimen.rate * math.exp(x[0]), specimen.fines * x[1]
        with tempfile.TemporaryDirectory(dir=out) as scratch:
            results = runner.run(name, stages, hours[-1], rate, residual, pathlib.Path(scratch))
            computed = fines_lost(results, hours)
        trials.append([len(trials) + 1, rate, residual, root_mean_square(computed - measured), *computed])
        return computed - measured

    # If everything that can leave has left before the first point, all high rates fit equally well:
    # the search starts from the best of a few decades, with a little more to lose than was lost.
    share = max(0.0, 1.0 - 0.0102 * max(measured))
    starts = [[math.log(factor), share] for factor in (0.01, 0.1, 1.0, 10.0, 100.0)]
    start = min(starts, key=lambda x: root_mean_square(difference(x)))
    # A step of a thousandth for differences is larger than the noise that the steps' tolerance
    # leaves.
    least_squares(difference, start, bounds=([-12.0, 0.0], [12.0, 1.0]), diff_step=1e-3, xtol=1e-7, ftol=1e-10)
    write_csv(out / "search.csv", ["trial", "rate", "residual", "misfit", *(f"fines_lost_{h:g}h" for h in hours)], trials)
    return min(trials, key=lambda trial: trial[3])


def root_mean_square(values):
    return float(numpy.sqrt(numpy.mean(numpy.square(values))))


def write_csv(path, names, rows):
    rows = [[f"{cell:.8g}" if isinstance(cell, float) else cell for cell in row] for row in rows]
    path.write_text(csv_text([names, *rows]), encoding="utf-8")


def work(options):
    measured, gradients = read_tests(options)
    runner = Runner(Specimen(options.scene), options.programs, options.set)
    out = pathlib.Path(options.out)
    out.mkdir(parents=True, exist_ok=True)
    trial, rate, residual, misfit, *_ = search(runner, options.fit, measured[options.fit], gradients[options.fit], out)

    searched, rows = runner.runs, []
    for name, points in measured.items():
        stages = gradients[name]
        results = runner.run(name, stages, stages[-1]["until_hours"], rate, residual, out)
        computed = fines_lost(results, [point["hours"] for point in points])
        use = "fitted" if name == options.fit else "predicted"
        rows += [[name, use, p["hours"], p["fines_lost"], float(c)] for p, c in zip(points, computed)]
    write_csv(out / "fit.csv", ["run", "use", "hours", "measured", "computed"], rows)

    print(f"rate      {rate:.6g}")
    print(f"residual  {residual:.6g}, {100.0 * residual / runner.specimen.fines:.4g} % of the fines")
    print(f"misfit    {misfit:.2g} per cent points, root mean square of {len(measured[options.fit])} points, trial {trial}")
    print(f"runs      {searched} of the search, {runner.runs - searched} after it")
    for name, use, hours, wanted, found in rows:
        print(f"{name:9s} {use:9s} after {hours:4g} h: measured {wanted:5.2f} %, computed {found:5.2f} %")


def main():
    parser = argparse.ArgumentParser(description="Fits rate and residual to one seepage test, predicts the others.")
    parser.add_argument("scene", metavar="SCENE")
    parser.add_argument("--measured", required=True, metavar="FILE")
    parser.add_argument("--gradients", required=True, metavar="FILE")
    parser.add_argument("--fit", required=True, metavar="RUN", help="the run to fit; the others are predicted")
    parser.add_argument("--programs", required=True, metavar="FOLDER")
    parser.add_argument("--out", required=True, metavar="FOLDER")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="changes a key of the scene")
    options = parser.parse_args()
    end_with("fit.py: ", lambda: work(options))


if __name__ == "__main__":
    main()

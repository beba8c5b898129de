#!/usr/bin/env python3
"""Fits the rate and the residual of an erosion law to one seepage test, and predicts another with them.

    fit.py SCENE --measured FILE --gradients FILE --fit RUN --programs FOLDER --out FOLDER [--set KEY=VALUE ...]

SCENE is a column without gravity whose first boundary has a pressure and whose second has none. A run is a
test: its gradients become that pressure. Needs Python 3.11 and SciPy. Writes search.csv, fit.csv and the
results of every run, RUN.results. Exit code 2: a table or the scene is wrong; 1: a program failed.
"""

import argparse
import csv
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib

import numpy
from scipy.optimize import least_squares

UNIT_WEIGHT = 9810.0  # of water, N/m3
RAISING = 60.0  # s that it takes to go from one gradient to the next


class InputError(Exception):
    """A table or a scene that is not as it should be."""


class ProgramError(Exception):
    """A program of Suffuse that failed."""


# --- Tables --------------------------------------------------------------------------------------------


def read_table(path, bounds):
    """Rows as (line, run, values by column); `bounds` has the smallest and largest value of each column."""
    columns = ["run", *bounds]
    try:
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.reader(file)
            names = next(reader, [])
            if names != columns:
                raise InputError(f"{path}:1: got the columns {','.join(names)}; expected {','.join(columns)}")
            rows = [(reader.line_num, cells) for cells in reader if cells]
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from error
    if not rows:
        raise InputError(f"{path}: got no row; expected at least one")
    return [read_row(f"{path}:{line}", cells, bounds) for line, cells in rows]


def read_row(place, cells, bounds):
    if len(cells) != len(bounds) + 1:
        raise InputError(f"{place}: got {len(cells)} cells; expected {len(bounds) + 1}")
    values = {}
    for (column, (low, high)), text in zip(bounds.items(), cells[1:]):
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not low <= value <= high or math.isinf(value):
            raise InputError(f"{place}: {column}: got '{text}'; expected a number from {low:g} to {high:g}")
        values[column] = value
    if not cells[0] or not cells[0].replace("-", "").replace("_", "").isalnum():
        raise InputError(f"{place}: run: got '{cells[0]}'; expected letters, digits, - or _")
    return place, cells[0], values


def read_runs(path, time, bounds):
    """The rows of each run. Times ascend."""
    runs = {}
    for place, name, values in read_table(path, {time: (0.0, math.inf), **bounds}):
        rows = runs.setdefault(name, [])
        if values[time] <= (rows[-1][time] if rows else 0.0):
            raise InputError(f"{place}: {time}: got {values[time]:g}; expected times above 0 that ascend within a run")
        rows.append(values)
    return runs


def read_tests(options):
    """What was measured and what was applied, by run; checks that they fit together."""
    measured = read_runs(options.measured, "hours", {"fines_lost": (0.0, 100.0), "conductance": (0.0, math.inf)})
    gradients = read_runs(options.gradients, "until_hours", {"gradient": (0.0, math.inf)})
    for name, points in measured.items():
        if name not in gradients:
            raise InputError(f"{options.gradients}: got no row of '{name}', which {options.measured} has")
        end = gradients[name][-1]["until_hours"]
        if points[-1]["hours"] > end:
            raise InputError(f"{options.measured}: {name}: got a point at {points[-1]['hours']:g} h; "
                             f"expected none after {end:g} h, where its gradients end")
    if options.fit not in measured:
        raise InputError(f"--fit: got '{options.fit}'; expected one of {', '.join(measured)}")
    if len(measured[options.fit]) < 2:
        raise InputError(f"{options.measured}: got one point of '{options.fit}'; "
                         "two parameters cannot be fitted to fewer than two points")
    return measured, gradients


# --- Runs ----------------------------------------------------------------------------------------------


class Specimen:
    """What the search must know of the scene."""

    def __init__(self, path):
        self.path = path
        try:
            with open(path, "rb") as file:
                scene = tomllib.load(file)
            (self.soil, soil), = scene["soil"].items()
            self.height = float(scene["geometry"]["height"])
            self.fines = 1.0 - soil["porosity"] - soil["skeleton_fraction"]
            self.rate = float(soil["erosion"]["rate"])
        except (OSError, tomllib.TOMLDecodeError) as error:
            raise InputError(f"{path}: cannot be read: {error}") from error
        except (KeyError, TypeError, ValueError) as error:
            raise InputError(f"{path}: expected a column of one soil with porosity, skeleton_fraction "
                             f"and erosion.rate as numbers; {error!r}") from error
        if not self.rate > 0.0 or not self.fines > 0.0:
            raise InputError(f"{path}: expected a rate and fines above 0")


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

    def call(self, program, *arguments):
        try:
            done = subprocess.run([self.programs / program, *arguments], capture_output=True, text=True,
                                  env={**os.environ, "OMP_NUM_THREADS": "1"})
        except OSError as error:
            raise ProgramError(f"{self.programs / program}: cannot be run: {error}") from error
        if done.returncode == 2:
            raise InputError(done.stderr.strip())
        if done.returncode != 0:
            raise ProgramError(f"{program} failed with exit code {done.returncode}:\n{done.stderr.strip()}")

    def run(self, name, stages, end, rate, residual, folder):
        """Computes a test up to `end`, h; returns its results folder."""
        erosion = f"soil.{self.specimen.soil}.erosion"
        changes = [*self.changes, f"name={name}", f"{erosion}.rate={rate:.17g}", f"{erosion}.residual={residual:.17g}",
                   f"boundary[0].pressure={pressures(stages, self.specimen.height)}", f"time.end={3600.0 * end:.17g}"]
        case, results = folder / f"{name}.case.h5", folder / f"{name}.results"
        shutil.rmtree(results, ignore_errors=True)
        self.call("suffuse-mesher", self.specimen.path, *(part for change in changes for part in ("--set", change)),
                  "-o", case)
        self.call("suffuse-solver", case, "-o", results)
        self.runs += 1
        return results


def fines_lost(results, hours):
    """Per cent of the fines that have left at these hours, by the ledger."""
    with open(results / "ledger.csv", newline="", encoding="utf-8") as file:
        rows = [{name: float(text) for name, text in row.items()} for row in csv.DictReader(file)]
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
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        writer.writerows([f"{cell:.8g}" if isinstance(cell, float) else cell for cell in row] for row in rows)


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
    try:
        work(parser.parse_args())
    except InputError as error:
        print(f"fit.py: {error}", file=sys.stderr)
        sys.exit(2)
    except ProgramError as error:
        print(f"fit.py: {error}", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Calibrates keys of a scene by what was measured. make calls it, with its variables in the environment and itself as MAKE; the
sweep's engine makes the runs, in the folder runs/.

Writes fit.csv, correlations.csv, search.csv, residuals.csv, report.md and charts into OUT/fit/NAME. Exit codes: 2 for wrong input;
1 if runs were stopped, or all failed.
"""

import math
import os
import pathlib
import re
import sys
import tempfile

import numpy
from scipy.special import chdtrc

workflows = pathlib.Path(__file__).resolve().parent.parent
sys.path[1:1] = [str(workflows), str(workflows / "sweep"), str(workflows / "convergence")]
from common import (InputError, NotDone, cell, csv_text, draw_curves, end_with, file_name, find_file, folder_of, is_number, programs_of,
                    run_json, write_changed)
from estimator import NEAR_BOUND, POOR, NoRun, derivatives, mark_not_linear, search, uncertainty
from keys import read_keys
from measured import check_outputs, computed, read_measured
from outputs import unit_of
from trials import Trials

# Changes of outputs below this share of their largest value are round-off, or that of an iteration.
NEGLIGIBLE = 1e-9
# Probability below which deviations that are given do not explain the misfit.
UNLIKELY = 0.01


class Fit:
    """The residuals of runs, and a list of all that were tried."""

    def __init__(self, keys, measured, trials):
        self.keys, self.measured, self.trials = keys, measured, trials
        self.scale = measured.scale()
        self.low, self.high = ([key.x_of(bound(key)) for key in keys] for bound in (lambda key: key.low, lambda key: key.high))
        self.tried = {}  # texts of the values -> row of search.csv
        self.outputs_known = False

    def texts(self, x):
        return tuple(key.text_at(float(part)) for key, part in zip(self.keys, x))

    def computed(self, row):
        return computed(self.measured, self.trials.results(row))

    def evaluate(self, points, purpose):
        texts = [self.texts(x) for x in points]
        rows = self.trials.run(texts)
        found = []
        for values, row in zip(texts, rows):
            residuals = None
            if row["status"] == "done":
                if not self.outputs_known:
                    check_outputs(self.measured, self.trials.results(row))
                    self.outputs_known = True
                residuals = (self.computed(row) - self.measured.value) / self.scale
            found.append(residuals)
            if values not in self.tried:
                misfit = "" if residuals is None else f"{math.sqrt(numpy.mean(residuals**2)):.8g}"
                self.tried[values] = [len(self.tried) + 1, row["run"], purpose, *values, misfit, row["status"], row["message"]]
                print(f"run {row['run']}, {purpose}: {', '.join(values)}: {'misfit ' + misfit if misfit else row['status']}", flush=True)
        return found

    def of_constant(self):
        """The sum of squares of the best constant for each output."""
        return sum(float(numpy.sum(((self.measured.value[at] - numpy.mean(self.measured.value[at])) / self.scale[at]) ** 2))
                   for _, at in self.measured.parts())


def calibrate(fit):
    """The search, and how well its result is known: Search, Known, row of the best run, whether the start ran."""
    found = search(fit.evaluate, [key.logarithmic for key in fit.keys], fit.low, fit.high, fit.of_constant())
    around = derivatives(fit.evaluate, fit.low, fit.high, found.x)
    (row,) = fit.trials.run([fit.texts(found.x)])
    at_bound = [j for j, x in enumerate(found.x) if min(x - fit.low[j], fit.high[j] - x) < NEAR_BOUND]
    negligible = numpy.zeros(len(fit.scale))
    parts = [at for _, at in fit.measured.parts()]
    for at in parts:
        negligible[at] = NEGLIGIBLE * max(numpy.max(numpy.abs(fit.computed(row)[at])), 1e-300) / fit.scale[at]
    has_deviations = fit.measured.deviation is not None
    return found, uncertainty(around, found.residuals, negligible, has_deviations, at_bound, parts), row


# --- Tables ------------------------------------------------------------------------------------------------


cell_of = lambda value: cell(value if math.isfinite(value) else None, 8)


def rows_of(fit, found, known):
    """The rows of fit.csv as dictionaries."""
    rows = []
    for j, (key, text) in enumerate(zip(fit.keys, fit.texts(found.x))):
        value, half = float(text), known.quantile * known.error[j]
        slope = key.slope_at(value)
        low, high = (value * math.exp(-half), value * math.exp(half)) if key.logarithmic else (value - slope * half, value + slope * half)
        rows.append({"key": key.name, "unit": key.unit, "searched": "logarithm" if key.logarithmic else "value", "start": cell_of(key.start),
                     "value": cell_of(value), "standard_error": cell_of(slope * known.error[j]), "low95": cell_of(low), "high95": cell_of(high),
                     "said": known.said[j]})
    return rows


def write_tables(folder, fit, rows, known, row):
    names = [key.name for key in fit.keys]
    measured, values = fit.measured, fit.computed(row)
    tables = {
        "fit": [list(rows[0]), *(list(row.values()) for row in rows)],
        "correlations": [["key", *names], *([name, *map(cell_of, line)] for name, line in zip(names, known.correlations))],
        "search": [["trial", "run", "purpose", *names, "misfit", "status", "message"], *fit.tried.values()],
        "residuals": [["t", "output", "measured", "computed"],
                      *([f"{t:.10g}", name, f"{value:.10g}", f"{found:.10g}"]
                        for t, name, value, found in zip(measured.t, measured.names, measured.value, values))],
    }
    for name, table in tables.items():
        write_changed(folder / f"{name}.csv", csv_text(table))


# --- Charts ------------------------------------------------------------------------------------------------


def column_of(output):
    """The name of an output for `suffuse-post figure curves`: TABLE.COLUMN or TABLE.COLUMN:PLACE."""
    place, _, column = output.rpartition(".")
    if place in ("history", "ledger"):
        return output
    if place.startswith("boundary."):
        return f"boundaries.{column}:{place.removeprefix('boundary.')}"
    table, number = re.fullmatch(r"(\w+)\[(\d+)\]", place).groups()
    return f"{table}s.{column}:{number}"


def draw(folder, fit, results, programs):
    """A chart of each output, OUTPUT.png and .svg. `results`: folders by the labels of their curves. A failure is a message."""
    end = max(fit.measured.t)
    unit = next((unit for unit, length in (("a", 31557600.0), ("d", 86400.0), ("h", 3600.0), ("min", 60.0)) if end > 3 * length), "s")
    with tempfile.TemporaryDirectory() as scratch:
        for label, folder_of_run in results.items():
            (pathlib.Path(scratch) / f"{label}.results").symlink_to(folder_of_run.resolve())
        for output, at in fit.measured.parts():
            points = pathlib.Path(scratch) / "measured.csv"
            rows = [[f"{t:.17g}", f"{value:.17g}"] for t, value in zip(fit.measured.t[at], fit.measured.value[at])]
            points.write_text(csv_text([["t", output.rpartition(".")[2]], *rows]), encoding="utf-8")
            said = draw_curves(folder / file_name(output), programs, column_of(output), *(f"{scratch}/{label}.results" for label in results),
                               "--measured", points, "--time-unit", unit)
            if said:
                print(f"fit.py: no chart of {output}: {said}", file=sys.stderr)


# --- Report ------------------------------------------------------------------------------------------------


def with_unit(text, unit):
    return f"{text} {unit}" if unit not in ("", "-") else text


def said_of_kink(fit, kink):
    """In which way larger and smaller values of a key act, as the end of a sentence."""
    if kink.output is None:
        return "the misfit rises at once to both sides"
    (more, word), (less, other) = sorted([(kink.above, "larger"), (kink.below, "smaller")], reverse=True)
    output = fit.measured.parts()[kink.output][0]
    if less < 0.01 * more:
        return f"{output} responds to {word} values, and hardly to {other} ones"
    if more < 1.1 * less:
        return f"{output} responds to {word} values at other times than to {other} ones"
    return f"{output} responds {more / less:.2g} times as much to {word} values as to {other} ones"


def key_sentence(fit, rows, known, j):
    row, name = rows[j], rows[j]["key"]
    value = with_unit(f"{float(row['value']):.5g}", row["unit"])
    said = known.said[j]
    if said in ("known", "not linear"):
        doubt = (f" This interval is doubtful: between its ends {said_of_kink(fit, known.kinks[j])}." if said == "not linear" else "")
        return (f"{name} is {value}; its standard error is {with_unit(format(float(row['standard_error']), '.2g'), row['unit'])}, and its 95 % interval "
                f"goes from {float(row['low95']):.5g} to {float(row['high95']):.5g}.{doubt}")
    if said == "not told apart":
        other = known.with_whom[j]
        whom = "the other keys" if other is None else f"{rows[other]['key']} (correlation {known.correlations[j, other]:.4g})"
        return f"{name} cannot be told apart from {whom} by these points: {value} is one of many values that fit as well."
    if said == "kink":
        return (f"{name} is {value}, where there is a kink: {said_of_kink(fit, known.kinks[j])}. A threshold that is equal to a gradient that was "
                "applied does this. A standard error would mean nothing, so there is none.")
    return {
        "no response": f"Nothing that was measured responds to {name}: these points say nothing of it, and it is left at {value}.",
        "at a bound": f"{name} ended at its bound, {value}: the points ask for a value beyond it, and its standard error is not known.",
        "runs failed": f"The standard error of {name} ({value}) is not known: runs with larger and smaller values failed.",
        "as many keys as points": f"{name} is {value}; its standard error is not known, as there are as many keys as points.",
    }[said]


def misfit_sentences(fit, found, known, row):
    values, measured = fit.computed(row), fit.measured
    dimension = int(run_json(fit.trials.results(row))["dimension"])
    sentences = []
    for output, at in measured.parts():
        misfit = math.sqrt(numpy.mean((values[at] - measured.value[at]) ** 2))
        sentences.append(f"The computed {output} differs from the measured one by {with_unit(f'{misfit:.3g}', unit_of(output, dimension))} "
                         f"(root mean square of {len(at)} points).")
    freedom = len(measured.t) - sum(said in ("known", "not told apart", "kink", "not linear") for said in known.said)
    if measured.deviation is not None and freedom > 0:
        likely = chdtrc(freedom, float(found.residuals @ found.residuals))
        sentences.append(f"The differences are {known.misfit:.3g} times those that the deviations of the points let expect"
                         + (": the scene does not explain the points, and the standard errors are too small." if likely < UNLIKELY else "."))
    return sentences


def report_of(fit, found, known, rows, row):
    searched = {"logarithm": [], "value": []}
    for entry in rows:
        searched[entry["searched"]].append(entry["key"])
    how = [f"The search took the {'logarithm' if word == 'logarithm' else 'value'} of {', '.join(names)}." for word, names in searched.items() if names]
    bad = [entry for entry in fit.tried.values() if entry[-2] != "done"]
    how.append(f"It made {len(fit.tried)} runs from {'one start' if found.starts == 1 else 'two starts'}; the best is {row['run']}.")
    if not found.converged:
        how.append("It ended before the misfit stopped falling: start it again from these values.")
    if bad:
        how.append(f"{len(bad)} of the runs did not end well and count as bad trials: "
                   + "; ".join(f"{entry[1]} {entry[-2]} ({entry[-1]})" for entry in bad[:5]) + ("; ..." if len(bad) > 5 else "."))
    if found.residuals @ found.residuals > POOR * fit.of_constant() > 0.0 and (fit.measured.deviation is None or known.misfit > 2.0):
        how.append("The fit explains little: a constant for each output would be nearly as good.")
    paragraphs = [" ".join(misfit_sentences(fit, found, known, row)), *(key_sentence(fit, rows, known, j) for j in range(len(rows))), " ".join(how)]
    return "\n\n".join(paragraphs) + "\n"


def work():
    if not any(os.environ.get(name) for name in ("SCENE", "MEASURED", "KEYS")):
        of_soils = [f"soil.{soil}.erosion.{key}" for soil in ("sand", "silt") for key in ("rate", "threshold")]
        os.environ |= {"SCENE": "fit/column.toml", "MEASURED": "fit/column.csv", "KEYS": ",".join(of_soils), "AGAINST": ""}
    scene, table, programs = find_file("SCENE"), find_file("MEASURED"), programs_of()
    folder = folder_of("fit", scene)
    keys, content = read_keys(os.environ.get("KEYS", ""), scene, programs)
    measured = read_measured(table, [name.strip() for name in os.environ.get("AGAINST", "").split(",") if name.strip()])
    if len(measured.t) < len(keys):
        raise InputError([f"{measured.path}: got {len(measured.t)} points; expected at least as many as there are keys, {len(keys)}"])
    end = content.get("time", {}).get("end")
    if is_number(end):
        measured.check_times(end)
    fit = Fit(keys, measured, Trials(scene, [key.name for key in keys], folder, programs))
    try:
        found, known, row = calibrate(fit)
    except NoRun:
        raise NotDone(["the run of the start and those of all other starts failed; mend the scene, or give other bounds in KEYS="]) from None
    mark_not_linear(fit.evaluate, fit.low, fit.high, found, known, [at for _, at in measured.parts()])
    rows = rows_of(fit, found, known)
    report = report_of(fit, found, known, rows, row)
    (start,) = fit.trials.run([fit.texts(numpy.zeros(len(keys)))])
    results = {label: fit.trials.results(run) for label, run in (("fit", row), ("start", start)) if run["status"] == "done"}
    write_tables(folder, fit, rows, known, row)
    write_changed(folder / "report.md", report)
    draw(folder, fit, results, programs)
    print(f"\n{report}\n{fit.trials.made} runs were made, {len(fit.tried) - fit.trials.made} were there. Tables, report and charts are in {folder.resolve()}")


if __name__ == "__main__":
    end_with("fit.py: ", work)

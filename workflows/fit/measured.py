"""What was measured, and the same outputs of a run.

    t,value                             one output, which AGAINST names
    t,history.flux_out,ledger.fines_out     a column for each output

An output is a column of a table of the results folder: history.NAME, ledger.NAME, boundary.NAME.COLUMN, probe[0].COLUMN
or section[0].COLUMN. The column `deviation`, or OUTPUT.deviation of each output, has standard deviations. An empty cell
is a value that was not measured.
"""

import functools
import re

import numpy

from common import InputError, number_of, problem, read_rows, wrong
from outputs import NO_OUTPUTS
from runs import lines_of

FORMS = "history.NAME, ledger.NAME, boundary.NAME.COLUMN, probe[0].COLUMN or section[0].COLUMN"
FORM = re.compile(r"(history|ledger)\.\w+|boundary\..+\.\w+|(probe|section)\[\d+\]\.\w+")
DEVIATION = "deviation"
# Tables with several places, and the column that tells them apart.
PLACES = {"boundaries": ("boundary", "boundary.{}"), "probes": ("probe", "probe[{}]"), "sections": ("section", "section[{}]")}


class Measured:
    """Points in the order of outputs, then of lines. `deviation` is None where the table gives none."""

    def __init__(self, path, outputs, points):
        points = sorted(points, key=lambda point: outputs.index(point[1]))
        self.path, self.outputs = path, outputs
        self.lines = [point[0] for point in points]
        self.names = [point[1] for point in points]
        self.t, self.value = (numpy.array([point[k] for point in points], dtype=float) for k in (2, 3))
        self.deviation = None if points[0][4] is None else numpy.array([point[4] for point in points])

    def parts(self):
        """The output and the indices of its points."""
        return [(name, [k for k, other in enumerate(self.names) if other == name]) for name in self.outputs]

    def scale(self):
        """What a difference of each point is divided by: its deviation, or the spread of its output.

        Without deviations and with one output all points weigh the same whatever the scale is.
        """
        if self.deviation is not None:
            return self.deviation
        scale = numpy.ones(len(self.t))
        for name, at in self.parts():
            values = self.value[at]
            spread = float(numpy.std(values))
            if spread == 0.0 and len(self.outputs) > 1:
                raise wrong(self.path, name, f"the value {values[0]:g} alone, which has no spread to weigh it by",
                            f"a column {name}.{DEVIATION} of standard deviations")
            scale[at] = spread or float(numpy.max(numpy.abs(values))) or 1.0
        return scale

    def check_times(self, end):
        late = [line for line, t in zip(self.lines, self.t) if t > end]
        if late:
            t = max(self.t)
            raise wrong(f"{self.path}:{late[0]}", "t", f"{t:.10g}", f"times up to {end:.10g} s, the end of the run")


def columns_of(path, line, header, against):
    """Pairs of an output and its column, and the columns of deviations by outputs."""
    where = f"{path}:{line}"
    if len(header) == 1 and ";" in header[0]:
        raise wrong(where, "", f'"{header[0]}"', "commas between columns")
    for name in header:
        if header.count(name) > 1:
            raise wrong(where, "", f'"{name}" twice', "each column once")
    if "t" not in header:
        raise wrong(where, "", ",".join(header), "a column t of times in s")
    named = [name for name in header if name not in ("t", "value") and not name.endswith(DEVIATION)]
    if "value" in header:
        if named:
            raise wrong(where, "", f'"value" and "{named[0]}"', "a column value, or columns named as outputs")
        if len(against) != 1:
            found = ",".join(against) or "nothing"
            raise wrong("AGAINST", "", f"'{found}'", f"one output that the column value is of: {FORMS}")
        outputs = {against[0]: "value"}
    else:
        missing = [name for name in against if name not in named]
        if missing or not named:
            raise InputError([problem(where, "", ",".join(header), f"a column {name}", named) for name in missing or ["value"]])
        outputs = {name: name for name in against or named}
    for name in outputs:
        if not FORM.fullmatch(name):
            raise wrong("AGAINST" if name in against else where, "", f"'{name}'", f"an output: {FORMS}")
    deviations = {name: f"{column}.{DEVIATION}" for name, column in outputs.items() if f"{column}.{DEVIATION}" in header}
    if DEVIATION in header:
        if len(outputs) > 1 or deviations:
            raise wrong(where, "", DEVIATION, f"OUTPUT.{DEVIATION} for each of several outputs")
        deviations = {name: DEVIATION for name in outputs}
    if deviations and len(deviations) < len(outputs):
        name = next(name for name in outputs if name not in deviations)
        raise wrong(where, "", f"no column {name}.{DEVIATION}", "deviations of all outputs or of none")
    return outputs, deviations


def read_number(where, column, text, least, expected):
    value = number_of(text)
    if value is None or not value >= least:
        raise wrong(where, column, f'"{text}"', expected)
    return value


def read_measured(path, against):
    """`against`: names of outputs; of all columns if there are none. Throws InputError."""
    (line, header), *rows = lines_of(path, "a line of columns and a line for each time")
    outputs, deviations = columns_of(path, line, header, against)
    points, problems = [], []
    for line, cells in rows:
        try:
            where = f"{path}:{line}"
            if len(cells) != len(header):
                raise wrong(where, "", f"{len(cells)} cells", str(len(header)))
            row = dict(zip(header, cells))
            t = read_number(where, "t", row["t"], 0.0, "a time of at least 0 s")
            for name, column in outputs.items():
                if not row[column]:
                    continue
                value = read_number(where, column, row[column], float("-inf"), "a number")
                deviation = None
                if name in deviations:
                    deviation = read_number(where, deviations[name], row[deviations[name]], 5e-324, "a number above 0")
                points.append((line, name, t, value, deviation))
        except InputError as error:
            problems.append(str(error))
    for name, column in outputs.items():
        if not problems and all(point[1] != name for point in points):
            problems.append(problem(path, column, "no value", "at least one"))
    if problems:
        raise InputError(problems)
    return Measured(path, list(outputs), points)


@functools.lru_cache(maxsize=4)
def curves_of(results):
    """All outputs of a run: arrays of times and values by their names."""
    curves = {}
    for table in ("history", "ledger", *PLACES):
        path = results / f"{table}.csv"
        place, form = PLACES.get(table, (None, table))
        for row in read_rows(path):
            start = form.format(row[place]) if place else form
            for column, text in row.items():
                if column not in NO_OUTPUTS and column != place:
                    times, values = curves.setdefault(f"{start}.{column}", ([], []))
                    times.append(float(row["t"]))
                    values.append(float(text))
    return {name: (numpy.array(times), numpy.array(values)) for name, (times, values) in curves.items()}


def check_outputs(measured, results):
    """Throws InputError if the run has not the outputs that were measured, or ends too early."""
    known = curves_of(results)
    unknown = [name for name in measured.outputs if name not in known]
    if unknown:
        raise InputError([problem(measured.path, "", f"'{name}'", "one of " + ", ".join(known), known) for name in unknown])
    measured.check_times(min(known[name][0][-1] for name in measured.outputs))


def computed(measured, results):
    """The outputs of a run at the points that were measured, linear between the rows of its tables."""
    curves = curves_of(results)
    values = numpy.empty(len(measured.t))
    for name, at in measured.parts():
        values[at] = numpy.interp(measured.t[at], *curves[name])
    return values

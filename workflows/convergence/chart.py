"""The chart of an output over mesh.size, drawn by `suffuse-post figure curves`, so it looks like all other charts.

suffuse-post draws tables of results folders. So each curve is written as history.csv into a folder that has the rest from
the coarsest run. A diamond around each value is part of its curve.
"""

import math
import pathlib
import re
import shutil
import sys
import tempfile

from common import csv_text, draw_curves, file_name

COPIED = ("run.json", "mesh.hdf.series", "solid.hdf.series", "liquid.hdf.series", "ledger.csv")
# Half a diamond, as a share of an axis.
MARK_X, MARK_Y = 0.015, 0.02


def with_diamonds(points, logarithmic_y):
    """A line through points of a logarithmic x with a diamond around each."""
    place, value = (math.log, math.exp) if logarithmic_y else (float, float)
    along, up = [math.log(x) for x, _ in points], [place(y) for _, y in points]
    width, height = MARK_X * (max(along) - min(along)), MARK_Y * (max(up) - min(up))
    corners = ((0, 0), (1, 0), (0, 1), (-1, 0), (0, -1), (1, 0), (0, 0))
    return [(math.exp(a + i * width), value(b + j * height)) for a, b in zip(along, up) for i, j in corners]


def curves_of(series, values, found):
    """Curves by their labels; whether they are distances from the extrapolated value."""
    sizes = series.numbers
    distances = [abs(value - found.extrapolated) for value in values]
    if found.kind != "in range" or not min(distances) > 0.0:
        return {"runs": list(zip(sizes, values))}, False
    curves = {"runs": list(zip(sizes, distances))}
    # Lines of whole orders near the observed one, through the value of the finest size.
    for order in (order for order in (1, 2, 3) if abs(order - found.order) <= 0.75):
        curves[f"order {order}"] = [(size, distances[-1] * (size / sizes[-1]) ** order) for size in (sizes[0], sizes[-1])]
    return curves, True


def draw(folder, name, unit, series, found, programs):
    """Writes NAME.png and NAME.svg. A failure is a message."""
    values = series.values(name)
    curves, logarithmic_y = curves_of(series, values, found)
    shown_unit = f" ({unit})" if unit else ""
    plain = re.sub(r"[.:]", " ", name)  # suffuse-post takes TABLE.COLUMN:PART apart
    y_label = f"distance of {plain} from its extrapolated value{shown_unit}" if logarithmic_y else f"{plain}{shown_unit}"
    x_label = "mesh.size (m)"
    with tempfile.TemporaryDirectory() as scratch:
        folders = []
        for number, (label, points) in enumerate(curves.items()):
            curve = pathlib.Path(scratch) / f"{label}.results"
            curve.mkdir()
            for file in COPIED:
                if (series.runs[0]["results"] / file).is_file():
                    shutil.copy(series.runs[0]["results"] / file, curve)
            line = with_diamonds(points, logarithmic_y) if number == 0 and len(set(values)) > 1 else points
            rows = [[row, x, y] for row, (x, y) in enumerate(line)]
            (curve / "history.csv").write_text(csv_text([["t", x_label, y_label], *rows]), encoding="utf-8")
            folders.append(curve)
        said = draw_curves(folder / file_name(name), programs, y_label, *folders, "--x", x_label, "--log-x", *["--log-y"] * logarithmic_y)
        if said:
            print(f"convergence.py: no chart of {name}: {said}", file=sys.stderr)

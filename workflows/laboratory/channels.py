#!/usr/bin/env python3
"""Tables when a channel crosses the specimen of channel.toml, with its width and the loss of fines.

    channels.py POST RESULTS... > TABLE
    channels.py --changes TABLE > CHANGES

POST is suffuse-post. A place is open where half of its fines are gone, and a channel has crossed the specimen when a
place near the inlet is open, by interpolation between snapshots. The second form compares free meshes whose sizes
halve: the change from the last but one to the last, over the last, and the observed order of the last three. An order
that no number stands for (differences of unlike signs, or none) is left empty.
"""

import bisect
import itertools
import json
import math
import pathlib
import sys
import tempfile

import numpy

sys.path.insert(1, str(pathlib.Path(__file__).resolve().parent.parent))
from common import call, cell, csv_text, read_rows

WIDTH, COUNT = 0.24, 2401  # of the specimen across the flow, m, and places across it
OPEN = 0.375  # porosity where half of the fines are gone
NEAR_INLET = 0.02  # m
ACROSS = [0.05, 0.10, 0.15, 0.20, 0.25, 0.30]  # where widths are taken, m
LOSS_AT = [200.0, 300.0, 1200.0, 2000.0, 3000.0]  # s
OUTPUTS = [*(f"lost_{time:g}s" for time in LOSS_AT), "through", "width_mm", "lost_when_through"]


def porosities(post, results, time, x):
    """Porosity along the line across the specimen at x."""
    with tempfile.TemporaryDirectory() as scratch:
        table = f"{scratch}/line.csv"
        call(post, "sample", results, "--time", f"{time:.17g}", "--line", f"{x},0:{x},{WIDTH}", "--count", COUNT, "--fields", "porosity",
             "--csv", table)
        return [float(row["porosity"]) for row in read_rows(table)]


def widths(post, results, time, x):
    """Lengths of the open parts of the line across the specimen at x, m."""
    parts = itertools.groupby(porosity >= OPEN for porosity in porosities(post, results, time, x))
    return [WIDTH / (COUNT - 1) * len(list(places)) for is_open, places in parts if is_open]


def break_through(post, results):
    """The time at which the specimen opens near its inlet; none if it never does."""
    times = [file["time"] for file in json.loads((results / "mesh.hdf.series").read_text())["files"]]
    is_open = lambda time: bool(widths(post, results, time, NEAR_INLET))
    if not is_open(times[-1]):
        return None
    after = bisect.bisect_left(times, True, 1, len(times) - 1, key=is_open)
    places = zip(*(porosities(post, results, time, NEAR_INLET) for time in times[after - 1 : after + 1]))
    share = min((OPEN - low) / (high - low) for low, high in places if high >= OPEN)
    return times[after - 1] + share * (times[after] - times[after - 1])


def lost(ledger, time):
    """Share of the fines that is gone, per cent; none after the end."""
    if time > ledger[-1]["t"]:
        return None
    return 100.0 * numpy.interp(time, *([row[name] for row in ledger] for name in ("t", "eroded"))) / ledger[0]["erodible"]


def setting(run, key, otherwise):
    """What the run sets a key of the scene to, as the text that was given."""
    given = dict(text.split("=", 1) for text in run["scene"]["overrides"])
    return given.get(key, otherwise).strip('"')


def shown(value, digits=4):
    return cell(value, digits)


def row_of(post, folder):
    results = pathlib.Path(folder)
    ledger = [{name: float(text) for name, text in row.items()} for row in read_rows(results / "ledger.csv")]
    run = json.loads((results / "run.json").read_text())
    cells = [results.stem, f"{1e3 * float(setting(run, 'soil.specimen.erosion.length', '0')):g}",
             setting(run, "mesh.structure", "free"), f"{1e3 * float(setting(run, 'mesh.size', 'nan')):g}",
             run["elements"], *(shown(lost(ledger, time)) for time in LOSS_AT)]
    time = break_through(post, results)
    if time is None:
        return [*cells, "", "", ""]
    channels = [width for x in ACROSS for width in widths(post, results, time, x)]
    width = 1e3 * sum(channels) / len(channels) if channels else None
    return [*cells, shown(time), shown(width, 3), shown(lost(ledger, time))]


def order(coarse, middle, fine):
    """Observed order on sizes that halve; none where the differences do not shrink or grow in one direction."""
    ratio = (coarse - middle) / (middle - fine) if middle != fine else 0.0
    return math.log2(ratio) if ratio > 0.0 else None


def changes_of(table):
    """A row for each output of each series of free meshes, from the finest three or two that have a value."""
    rows = [row for row in read_rows(table) if row["structure"] == "free"]
    yield ["series", "length_mm", "output", "finest_mm", "coarse", "middle", "fine", "change_percent", "order"]
    for (series, length), members in itertools.groupby(rows, lambda row: (row["run"].split("-")[0], row["length_mm"])):
        finest = sorted(members, key=lambda row: -float(row["size_mm"]))[-3:]
        for output in OUTPUTS:
            values = [float(row[output]) if row[output] else None for row in finest]
            if None in values[-2:]:
                continue
            change = 100.0 * (values[-2] / values[-1] - 1.0) if values[-1] else None
            observed = order(*values) if len(values) == 3 and None not in values else None
            yield [series, length, output, finest[-1]["size_mm"], *map(shown, values), shown(change, 2), shown(observed, 2)]


def main():
    if len(sys.argv) < 3:
        sys.exit("channels.py: expected POST RESULTS... or --changes TABLE")
    if sys.argv[1] == "--changes":
        rows = changes_of(sys.argv[2])
    else:
        header = ["run", "length_mm", "structure", "size_mm", "elements", *OUTPUTS]
        rows = [header, *(row_of(sys.argv[1], folder) for folder in sys.argv[2:])]
    print(csv_text(rows), end="")


if __name__ == "__main__":
    main()

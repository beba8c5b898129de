#!/usr/bin/env python3
"""Tables when a channel crosses the specimen of channel.toml, with its width and the loss of fines.

    channels.py POST RESULTS... > TABLE

POST is suffuse-post. A place is open where half of its fines are gone. Nothing but Python is needed.
"""

import csv
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

WIDTH, COUNT = 0.24, 2401  # of the specimen across the flow, m, and places across it
OPEN = 0.375  # porosity where half of the fines are gone
NEAR_INLET = 0.02  # m
ACROSS = [0.05, 0.10, 0.15, 0.20, 0.25, 0.30]  # where widths are taken, m
LOSS_OF_ALL = [1200.0, 3000.0]  # s


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [{name.split(" [")[0]: float(text) for name, text in row.items()} for row in csv.DictReader(file)]


def widths(post, results, time, x):
    """Lengths of the open parts of the line across the specimen at x, m."""
    with tempfile.TemporaryDirectory() as scratch:
        table = f"{scratch}/line.csv"
        subprocess.run([post, "sample", results, "--time", f"{time:.17g}", "--line", f"{x},0:{x},{WIDTH}",
                        "--count", str(COUNT), "--fields", "porosity", "--csv", table], check=True)
        parts = itertools.groupby(row["porosity"] >= OPEN for row in read(table))
        return [WIDTH / (COUNT - 1) * len(list(places)) for is_open, places in parts if is_open]


def break_through(post, results):
    """The time of the first snapshot in which the specimen is open near its inlet; none if it never is."""
    times = [file["time"] for file in json.loads((results / "mesh.hdf.series").read_text())["files"]]
    if not widths(post, results, times[-1], NEAR_INLET):
        return None
    low, high = 0, len(times) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if widths(post, results, times[middle], NEAR_INLET):
            high = middle
        else:
            low = middle
    return times[high]


def row_of(post, folder):
    results = pathlib.Path(folder)
    ledger = read(results / "ledger.csv")

    def lost(time):
        row = min(ledger, key=lambda row: abs(row["t"] - time))
        return f"{100.0 * row['eroded'] / ledger[0]['erodible']:.4g}"

    run = json.loads((results / "run.json").read_text())
    cells = [results.stem, run["elements"], *(lost(time) for time in LOSS_OF_ALL)]
    time = break_through(post, results)
    if time is None:
        return [*cells, "", "", ""]
    channels = [width for x in ACROSS for width in widths(post, results, time, x)]
    return [*cells, f"{time:g}", f"{1e3 * sum(channels) / len(channels):.3g}", lost(time)]


def main():
    if len(sys.argv) < 3:
        sys.exit("channels.py: expected POST RESULTS...")
    writer = csv.writer(sys.stdout, lineterminator="\n")
    writer.writerow(["run", "elements", *(f"lost_{time:g}s" for time in LOSS_OF_ALL), "through", "width_mm",
                     "lost_when_through"])
    writer.writerows(row_of(sys.argv[1], folder) for folder in sys.argv[2:])


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""What the paper says beside what the runs have: join.py paper-says.csv runs.csv

Each row of the first has the values of its column in the runs that it names. `exact` may name a column too.
"""

import pathlib
import re
import sys

sys.path.insert(1, str(pathlib.Path(__file__).resolve().parent.parent))
from common import csv_text, read_csv, read_rows

(_, *said), runs = read_csv(sys.argv[1]), {row["run"]: row for row in read_rows(sys.argv[2])}
columns = next(iter(runs.values()))


def of(run, name):
    """Counts as they are, other numbers to four digits, words as they are."""
    if not run:
        return ""
    if run not in runs or name not in columns:
        sys.exit(f"{sys.argv[1]}: no column {name} of a run {run}")
    value = runs[run][name]
    return f"{float(value):.4g}" if re.match(r"-?\d+[.e]", value) else value


rows = [["quantity", "unit", "paper_says", "exact", "single_point", "double_point", "runs"]]
for quantity, unit, paper, exact, column, single, double in said:
    rows.append([quantity, unit, paper, of(double or single, exact) if exact in columns else exact, of(single, column), of(double, column),
                 " ".join(run for run in (single, double) if run)])
print(csv_text(rows), end="")

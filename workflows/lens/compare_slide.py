#!/usr/bin/python3
"""When a levee has moved so far, as CSV, beside its plane section: compare_slide.py LEVEE-HISTORY SECTION-HISTORY

Times in s, of the first row of the history with that displacement; none: not within the run.
"""

import pathlib
import sys

sys.path.insert(1, str(pathlib.Path(__file__).resolve().parent.parent))
from common import read_rows

levee, section = (read_rows(path) for path in sys.argv[1:])


def reached(table, displacement):
    return next((row["t"] for row in table if float(row["displacement_max"]) >= displacement), "none")


print("displacement,t_section,t_levee")
for displacement in (0.01, 0.05, 0.1):
    print(displacement, reached(section, displacement), reached(levee, displacement), sep=",")

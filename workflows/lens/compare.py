#!/usr/bin/python3
"""Compares the lens with its plane section, as CSV: compare.py LENS-HISTORY SECTION-HISTORY

Half of the lens is 1.5 m wide, half of the model 6 m.
"""

import pathlib
import sys

sys.path.insert(1, str(pathlib.Path(__file__).resolve().parent.parent))
from common import read_rows

lens, section = ({row["t"]: row for row in read_rows(path)} for path in sys.argv[1:])
print("t,eroded_section,eroded_lens,discharge_section,discharge_lens")
for t in section:
    if t in lens:
        values = [float(table[t][name]) / width for name, of_lens in (("eroded", 1.5), ("flux_in", 6.0)) for table, width in ((section, 1.0), (lens, of_lens))]
        print(t, *(f"{value:.6g}" for value in values), sep=",")

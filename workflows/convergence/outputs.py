"""Outputs of a run that a study of convergence knows: numbers at its end, with their units.

    fines_lost              share of the fines that could erode at the start
    fines_lost_mass         the same in kg: the column fines_lost of the table of runs
    NAME                    other columns of the table of runs, of history.csv and of ledger.csv
    probe[0].NAME           a column of probes.csv
    section[0].NAME         a column of sections.csv
"""

import pathlib
import sys

from common import last_rows

# Columns of the table of runs, from this one on, are results at the end of the run.
FIRST_RESULT = "eroded"
# Settings and texts of the tables, and what is 0 but for round-off.
NO_OUTPUTS = {"t", "dt", "probe", "section", "x", "y", "z", "newton_iterations", "inertia", "residual_water", "residual_grains"}
UNITS = {"fines_lost": "-", "fines_lost_mass": "kg", "fines_lost_percent": "%", "turbidity_max": "g/l",
         "flux_out_low": "m3/s", "flux_out_high": "m3/s", "flux_out_estimate": "m3/s"}
WORDS = {
    "fines_lost": "share of fines lost", "fines_lost_mass": "mass of fines lost", "fines_lost_percent": "share of fines lost",
    "flux_out": "discharge that leaves", "flux_in": "discharge that enters", "settlement_max": "largest settlement",
    "porosity_mean": "mean porosity", "eroded": "mass that eroded", "water_out": "mass of water that left",
    "fines_out": "mass of fines that left", "turbidity_max": "largest turbidity", "displacement_max": "largest displacement",
}


def words_of(name):
    return f"{WORDS[name]} ({name})" if name in WORDS else f"output {name}"


def outputs_of(results, row):
    """All outputs of a run as texts by their names. `row`: that of sweep.csv."""
    columns = list(row)
    found = {}
    if row.get("fines_lost_percent"):
        found["fines_lost"] = repr(float(row["fines_lost_percent"]) / 100.0)
        found["fines_lost_mass"] = row["fines_lost"]
    start = columns.index(FIRST_RESULT) if FIRST_RESULT in columns else len(columns)
    for name in columns[start:]:
        if row[name]:
            found.setdefault(name, row[name])
    for table, number in (("history", ""), ("ledger", ""), ("probes", "probe"), ("sections", "section")):
        for last in last_rows(results / f"{table}.csv"):
            start = f"{number}[{last[number]}]." if number else ""
            for name, value in last.items():
                if name not in NO_OUTPUTS:
                    found.setdefault(start + name, value)
    return found


def unit_of(name, dimension):
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent / "post" / "python"))
    import suffuse  # here, as it takes a third of a second

    column = name.rpartition(".")[2]
    unit = UNITS.get(column) or suffuse.UNIT_OF_COLUMN.get(column, "")
    return f"{unit}/m" if dimension == 2 and unit in suffuse.PER_THICKNESS else unit

#!/usr/bin/python3
"""Are the known values of the study of accuracy those of tables of exact ones? Prints what fails."""

from expectations import expect_near, finish, workflows
from common import read_rows
from study import profile, reference

TABLES = workflows.parent / "tests/data/reference"


def expect_profile(what, law, rate, table, where, value=lambda row: float(row["c"]), **options):
    """Concentrations at the depths of a table, between those of the profile."""
    c = [row[3] for row in profile(law, rate, [12], expansion=0.0, count=1000, across=["0"], **options)]
    rows = [row for row in read_rows(TABLES / table) if 0 < float(row["x"]) < 1 and float(row["t"]) == 12 and where(row)]
    places = [int(float(row["x"]) * 1000 + 0.5) for row in rows]
    most = max(abs((c[k - 1] + c[k]) / 2 - value(row)) for k, row in zip(places, rows))
    expect_near(f"{what}: {len(rows)} rows", 0.0, most if len(rows) >= 9 else 1.0, 2e-5)


def expect_flux(what, problem, factor, table, where, column):
    known = {float(t): -float(q) for t, q in (line.split(",") for line in reference(problem)[1:])}
    rows = [row for row in read_rows(TABLES / table) if where(row) and float(row["t"]) in known]
    most = max(abs(known[float(row["t"])] / (factor * float(row[column])) - 1) for row in rows)
    expect_near(f"{what}: {len(rows)} rows", 0.0, most if len(rows) >= 2 else 1.0, 1e-6)


def check_known_values():
    expect_profile("grains along the column, constant law", "constant", 5e-3, "fines-profile.csv",
                   lambda row: row["law"] == "const" and float(row["par"]) == 0.005 and float(row["q"]) == 0.012)
    expect_profile("grains along the column, logarithmic law", "logarithmic", 1e-2, "fines-profile.csv",
                   lambda row: row["law"] == "log" and float(row["q"]) == 0.012)
    expect_profile("grains along the column, first-order law", "first-order", 0.05, "fines-profile-first-order-law.csv", lambda row: True,
                   lambda row: float(row["n_f"]) / float(row["n_L"]))
    expect_profile("grains where porosity varies", "constant", 1e-3, "fines-profile-nonuniform-porosity.csv", lambda row: True, n0=0.25, slope=0.1)
    # The table has velocities.
    expect_flux("flux that starts up", "startup", 0.3, "flow-startup.csv",
                lambda row: row["case"] == "physical" and row["quantity"] == "mean_v" and float(row["k"]) == 0.02, "value")
    # The table is for a soil with ten times the conductivity.
    expect_flux("flux that grows with porosity", "feedback", 0.1, "permeability-feedback.csv", lambda row: float(row["alpha"]) == 0.005, "q")


finish("known values of the study of accuracy", globals())

#!/usr/bin/python3
"""What held of the results of the sweeps.

    study.py check STRESS.csv                     a line for each sweep, and the failures; exit code 1 if there are any
    study.py document STRESS.csv PROGRAM DOCS     the tables in DOCS/evidence/stability.md, the chart in DOCS/images; PROGRAM is
                                                  suffuse-stress
"""

import collections
import pathlib
import re
import shutil
import sys

sys.path.insert(1, str(pathlib.Path(__file__).resolve().parent.parent))
from common import call, markdown, put_between, read_rows

VERDICTS = ("pass", "refused", "failed")
# What stands before the message of a program, and differs from run to run.
BEFORE = (r"^--set [^\n]*}: ", r"^.*--set [^ ]*: ", r"^stress.toml(:[0-9]+)?: ", r"^suffuse-solver: error: ", r"^[^ ]*\.case\.h5: ")


def of_sweeps(rows):
    sweeps = {}
    for row in rows:
        sweeps.setdefault(row["sweep"], []).append(row)
    return sweeps


def counts(rows):
    return [sum(row["verdict"] == verdict for row in rows) for verdict in VERDICTS]


def seconds(rows):
    return [float(row["seconds"]) for row in rows]


def check(table):
    rows = read_rows(table)
    for sweep, own in of_sweeps(rows).items():
        passed, refused, failed = counts(own)
        print(f"{sweep:<14} {len(own):4d} runs: {passed:4d} pass, {refused:3d} refused, {failed} failed; {sum(seconds(own)):.0f} s, "
              f"the longest {max(seconds(own)):.1f} s")
    for row in rows:
        if row["verdict"] == "failed":
            print(f"failed: {row['sweep']}, {row['scheme']}, {row['parameters']}, seed {row['seed']}: {row['message']}")
    failed = counts(rows)[-1]
    print(f"{len(rows)} runs, {failed} failed")
    return 1 if failed else 0


def number(value):
    return f"{value:.1e}" if value else "0"


def largest(rows, column):
    return max((float(row[column]) for row in rows if row[column]), default=0.0)


def facts(rows):
    """What is known of the results of the runs that pass."""
    rows = [row for row in rows if row["verdict"] == "pass" and row["sweep"] != "energy"]
    bounded = [row for row in rows if float(row["bounded"] or 0)]
    others = [row for row in rows if row not in bounded and not re.search("explicit|mixed|material", row["scheme"])]
    worst = max(others, key=lambda row: float(row["overshoot"] or 0), default=None)
    elsewhere = float(worst["overshoot"] or 0) if worst else 0.0
    where = ", ".join(worst[name] for name in ("sweep", "scheme", "parameters")) if elsewhere else ""
    fitted = min([0.0, *(float(row["fitted_min"]) for row in rows if row["fitted_min"])])
    return [f"- Pressures have bounds in {len(bounded)} runs; they leave them by {number(largest(bounded, 'overshoot'))} of their range. "
            f"Elsewhere by up to {number(elsewhere)} ({where}).",
            f"- Mean porosities that are known are met to {number(largest(rows, 'porosity_error'))}, discharges that are known to "
            f"{number(largest(rows, 'discharge_error'))} (implicit, tolerance 1e-3).",
            f"- The least-squares field of $c$ of double-point snapshots falls to {fitted:.2g}; the points themselves stay in $[0, 1)$."]


def refusals(rows):
    """Rows of the table of messages. The same sentence with other numbers is the same message."""
    times, example = collections.Counter(), {}
    for row in rows:
        if row["verdict"] == "refused":
            message = row["message"]
            for start in BEFORE:
                message = re.sub(start, "", message)
            # The first sentence, with numbers that are not padded.
            message = re.sub(r"\s+", " ", message.split(" / ")[0]).replace("( ", "(").replace(";", ",")
            kind = re.sub(r"-?[0-9][-+0-9.e]*", "#", message)
            times[kind] += 1
            example.setdefault(kind, [row["sweep"], message.replace("|", "\\|")])
    return [[times[kind], *found] for kind, found in example.items()]


def document(table, program, docs):
    rows = read_rows(table)
    does = dict(line.split(",", 1) for line in call(program, "--list").stdout.splitlines())
    lines = [[sweep, does[sweep], len(own), *counts(own), number(largest(own, "residual")), f"{max(seconds(own)):.1f}"]
             for sweep, own in of_sweeps(rows).items()]
    lines.append(["all", "", len(rows), *counts(rows), "", ""])
    header = ["sweep", "what", "runs", *VERDICTS, "largest residual", "longest run, s"]
    parts = ["", markdown(header, lines, range(8)), "Of the sweep `energy` the residual is the largest drift or growth of energy. "
             f"Processor time in all: {sum(seconds(rows)):.0f} s.\n", *facts(rows), "", "What was refused, with numbers of the first run that was:\n",
             markdown(["runs", "sweep", "message"], refusals(rows), range(3))]
    put_between("stress", pathlib.Path(docs) / "evidence/stability.md", "\n".join(parts))
    shutil.copy(pathlib.Path(table).with_suffix(".png"), pathlib.Path(docs) / "images/stress.png")


if __name__ == "__main__":
    sys.exit({"check": check, "document": document}[sys.argv[1]](*sys.argv[2:]))

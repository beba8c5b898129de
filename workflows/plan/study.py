#!/usr/bin/python3
"""How good the estimate of a scene is, and what its plan gains.

    study.py measure SOLVER NAME.case.h5 STEM [skips]    writes STEM.csv, one line without a header, and STEM.explain;
                                                         with `skips` also what the plan gains: another run with --no-skip
    study.py report PLAN.csv [DOCUMENT.md]               prints the table, and puts it between the marks of the document

`report` ends with exit code 1 when a run with the plan differs from the one without by more than its bound, or fewer than 20
scenes (all, of fewer) have all their estimates within a factor of two. Wall time is judged from 5 s on: below, the machine's
moods decide. Runs that take less are made three times, for the median.
"""

import pathlib
import re
import shutil
import sys

sys.path.insert(1, str(pathlib.Path(__file__).resolve().parent.parent))
from common import call, estimate_of, markdown, median, number_of, pass_seconds, passes, put_between, read_csv, read_rows, run_json

SMALL = 5
# These columns are not results: they say how long steps are and how large errors are.
NO_RESULTS = {"dt", "residual_water", "residual_grains", "eos_error", "pressure_overshoot", "pressure_scatter", "volume_defect"}


def compare(one, other, left_out):
    """The largest difference between two tables of the same run, relative to the column's largest value, and its column."""
    (header, *rows), (header_of_other, *others) = read_csv(one), read_csv(other)
    if header != header_of_other or [row[0] for row in rows] != [row[0] for row in others]:
        sys.exit(f"study.py: columns or times differ: {one}, {other}")
    worst = 0.0, "-"
    for k, name in enumerate(header):
        pairs = [[number_of(row[k]) or 0.0 for row in pair] for pair in zip(rows, others)]
        apart = max((abs(a - b) for a, b in pairs), default=0.0)
        if name not in left_out and apart > 0.0:
            worst = max(worst, (apart / max(abs(value) for pair in pairs for value in pair), name), key=lambda found: found[0])
    return worst


def measure(solver, case, stem, skips=""):
    explained = call(solver, case, "--explain").stdout
    pathlib.Path(f"{stem}.explain").write_text(explained, encoding="utf-8")
    options = {"with": [], "without": ["--no-skip"]} if skips else {"with": []}
    results = {name: f"{stem}.{name}.results" for name in options}
    seconds, of_passes = ({name: [] for name in options} for _ in range(2))
    runs = {}
    while not runs or float(seconds["with"][0]) < SMALL and len(seconds["with"]) < 3:
        for name, option in options.items():
            call(solver, case, "-o", results[name], "--force", "--quiet", *option)
            runs[name] = run_json(results[name])
            seconds[name].append(runs[name]["wall_seconds"])
            of_passes[name].append(pass_seconds(runs[name]))
    difference = bound = ""
    column = ""
    if skips:
        # A flow that was kept differs from the solved one within time.tolerance, by default 1e-3; everything else is exact.
        kept = any(int(found["calls"]) for found in passes(runs["with"], "flow, steady and kept$"))
        tolerance = re.search(r"steps chosen for a local error of ([-+.e0-9]*)", explained)
        bound = f"{0.1 * float(tolerance[1] if tolerance else 1e-3):g}" if kept else "1e-12"
        difference, column = max(compare(*(f"{folder}/{table}.csv" for folder in results.values()), NO_RESULTS if kept else ())
                                 for table in ("history", "ledger"))
        difference = f"{difference:.3g}"
    of_each = lambda values: [values(name) if name in options else "" for name in ("with", "without")]
    size = sum(file.stat().st_size for file in pathlib.Path(results["with"]).rglob("*") if file.is_file())
    line = [pathlib.Path(stem).name, *of_each(lambda name: median(seconds[name])), *of_each(lambda name: median(of_passes[name])),
            *of_each(lambda name: runs[name]["steps"]), difference, column, bound, runs["with"]["memory_bytes"], size, *estimate_of(explained)]
    pathlib.Path(f"{stem}.csv").write_text(",".join(map(str, line)) + "\n", encoding="utf-8")
    for folder in results.values():
        shutil.rmtree(folder)


HEADER = ("scene", "s, plan", "s, all", "speed-up", "of passes", "steps", "steps, all", "difference", "where largest", "bound",
          "steps", "seconds", "memory", "disk")
WIDTHS = (-22, 9, 9, 10, 11, 9, 12, 12, 22, 9, 8, 9, 8, 8)


def ratio(row, name):
    """How an estimate compares with what it was for, and whether it misses that."""
    if not row[f"estimate_{name}"]:
        return "none (!)", True
    found = float(row[f"estimate_{name}"]) / float(row[name])
    if name == "seconds" and float(row["seconds"]) < SMALL:
        return f"({found:.2f})", False
    missed = not 0.5 <= found <= 2.0
    return f"{found:.2f}" + " (!)" * missed, missed


def cells_of(row):
    """The cells of a scene, whether its run differs by more than its bound, and whether an estimate misses."""
    ratios, missed = zip(*(ratio(row, name) for name in ("steps", "seconds", "memory", "disk")))
    gains, wrong, difference = [""] * 3, False, ""
    if row["steps_no_skip"]:
        gain = lambda name: f"{float(row[f'{name}_no_skip']) / (float(row[name]) or 1):.2f}"
        gains = [f"{float(row['seconds_no_skip']):.3g}", gain("seconds"), gain("passes")]
        wrong = float(row["difference"]) > float(row["bound"])
        difference = (f"{float(row['difference']):.1e}" if float(row["difference"]) else "0") + " (!)" * wrong
    return [row["scene"], f"{float(row['seconds']):.3g}", *gains, row["steps"], row["steps_no_skip"], difference, row["column"],
            row["bound"], *ratios], wrong, any(missed)


def report(table, document=None):
    lines, wrong, missed = zip(*map(cells_of, read_rows(table)))
    if document:
        put_between("table", document, markdown(HEADER, lines, (0, 8)))
    for line in (HEADER, *lines):
        print("".join(f"{text:<{-width}}" if width < 0 else f"{text:>{width}}" for text, width in zip(line, WIDTHS)))
    return 1 if any(wrong) or missed.count(False) < min(len(lines), 20) else 0


if __name__ == "__main__":
    sys.exit({"measure": measure, "report": report}[sys.argv[1]](*sys.argv[2:]))

#!/usr/bin/env python3
"""Runs an implicit scene on one process and on several ranks.

Through iterations pressures differ in their last digits: tables have to agree to a share of the largest
value of each column, masses have to balance, and a second run on as many ranks has to have the same
bytes, also one that goes on from its middle.

    near_files.py FOLDER_OF_PROGRAMS SCENE.toml RANKS SHARE [MESHER OPTION...]
"""
import csv
import filecmp
import pathlib
import shutil
import subprocess
import sys
import tempfile

programs, scene, ranks, share = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3], float(sys.argv[4])
# Round-off, and what follows from it.
OF_ROUND_OFF = {"residual_water", "residual_grains", "eos_error", "dt"}


def run(program, *arguments):
    done = subprocess.run([programs / program, *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{program}: exit code {done.returncode}\n{done.stderr}")


def table(folder, name):
    with open(folder / name, newline="") as file:
        return list(csv.DictReader(file))


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def difference(one, other):
    """The largest difference of a column over its largest value, and its name."""
    worst = (0.0, "")
    for name in ["history.csv", "ledger.csv", "regions.csv", "boundaries.csv", "probes.csv", "sections.csv"]:
        if not (one / name).exists():
            continue
        a, b = table(one, name), table(other, name)
        if len(a) != len(b):
            sys.exit(f"{name}: {len(a)} and {len(b)} rows")
        for column in a[0]:
            pairs = [(number(x[column]), number(y[column])) for x, y in zip(a, b)]
            if column in OF_ROUND_OFF or pairs[0][0] is None:
                continue
            largest = max(abs(x) for x, _ in pairs)
            # What is less than this is the spread of transport over elements that nothing has reached.
            if largest > 1e-30:
                worst = max(worst, (max(abs(x - y) for x, y in pairs) / largest, f"{name} {column}"))
    return worst


def expect_same(one, other):
    names = sorted(str(p.relative_to(one)) for p in one.rglob("*") if p.is_file() and p.name not in ("run.json", ".lock"))
    others = sorted(str(p.relative_to(other)) for p in other.rglob("*") if p.is_file() and p.name not in ("run.json", ".lock"))
    if names != others:
        sys.exit(f"files: {names} and {others}")
    for name in names:
        if not filecmp.cmp(one / name, other / name, shallow=False):
            sys.exit(f"{one.name}/{name} and {other.name}/{name} differ")


with tempfile.TemporaryDirectory() as place:
    folder = pathlib.Path(place)
    case = folder / "case.h5"
    run("suffuse-mesher", scene, "-o", case, "--set", "output.restarts=100", *sys.argv[5:])
    run("suffuse-solver", case, "-o", folder / "alone", "--quiet")
    run("suffuse-solver", case, "-o", folder / "shared", "--quiet", "--ranks", ranks)
    apart, where = difference(folder / "alone", folder / "shared")
    balance = max(abs(float(row[key])) for row in table(folder / "shared", "ledger.csv")
                  for key in ("residual_water", "residual_grains"))
    print(f"tables differ by {apart:.2e} at most ({where}), masses balance to {balance:.1e}")
    if not apart <= share:
        sys.exit(f"expected tables within {share:.1e}")
    if not balance <= 1e-12:
        sys.exit("expected masses that balance to 1e-12")
    # Same ranks, same bits, also where the run goes on from its middle.
    again = folder / "again"
    shutil.copytree(folder / "shared", again)
    snapshots = sorted((again / "snapshots").glob("mesh_0*.hdf"))
    for snapshot in snapshots[len(snapshots) // 2:]:
        for file in again.glob(f"snapshots/*{snapshot.name[4:]}"):
            file.unlink()
    run("suffuse-solver", case, "-o", again, "--quiet", "--ranks", ranks, "--resume")
    expect_same(folder / "shared", again)
    # The state of ranks is one that a single process goes on from.
    for snapshot in snapshots[len(snapshots) // 2:]:
        for file in again.glob(f"snapshots/*{snapshot.name[4:]}"):
            file.unlink()
    run("suffuse-solver", case, "-o", again, "--quiet", "--resume")
    if not difference(folder / "alone", again)[0] <= share:
        sys.exit("a run that went on in one process differs")

#!/usr/bin/env python3
"""Runs the scenes of this folder and compares how they end with cases.csv. README.md says what the columns mean."""

import argparse
import csv
import os
import pathlib
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PROGRAMS = {"mesher", "solver", "explain"}
GROUPS = {"quick", "long"}
PIPE = "fifo"  # a pipe in the folder of each case, which nothing writes to


def read_cases():
    with open(HERE / "cases.csv", newline="") as table:
        cases = list(csv.DictReader(table))
    for case in cases:
        if case["programs"] not in PROGRAMS or case["group"] not in GROUPS:
            sys.exit(f"cases.csv: {case['case']}: expected programs in {PROGRAMS} and group in {GROUPS}")
    return cases


def run(command, folder, limit):
    """Exit code, output and processor time in s; exit code 'time' beyond the limit."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    # The limit of wall time is a multiple, because machines are shared.
    try:
        done = subprocess.run(command, cwd=folder, timeout=10 * limit + 30, text=True, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors="replace")
        code, output = done.returncode, done.stdout
    except subprocess.TimeoutExpired as expired:
        code, output = "time", (expired.stdout or b"").decode(errors="replace")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return code, output, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def problems_of(case, bin_folder, folder):
    """What is wrong with the end of a case, as a list of sentences, and its processor time in s."""
    limit = float(case["seconds"])
    stem = pathlib.Path(case["scene"]).stem
    options = shlex.split(case["options"])
    meshes = case["programs"] == "mesher"
    command = [bin_folder / "suffuse-mesher", HERE / case["scene"], "-o", "case.h5"]
    code, output, spent = run(command + (options if meshes else []), folder, limit)
    if not meshes:
        if code != 0:
            return [f"the mesher ended with {code}: {output.strip()}"], spent
        command = [bin_folder / "suffuse-solver", "case.h5", "-o", f"{stem}.results"]
        if case["programs"] == "explain":
            command.append("--explain")
        code, output, seconds = run(command + options, folder, limit)
        spent += seconds
    problems = []
    if str(code) != case["exit"]:
        problems.append(f"exit code {code}, expected {case['exit']}: {output.strip()[-600:]}")
    if case["says"] and case["says"] not in output:
        problems.append(f"does not say '{case['says']}': {output.strip()[-600:]}")
    if spent > limit:
        problems.append(f"took {spent:.1f} s of processor time, expected at most {limit:g} s")
    results = folder / f"{stem}.results"
    if code == 0 and results.is_dir():  # a table of factors is a file
        code, output, _ = run([bin_folder / "suffuse-post", "ledger", results, "--tolerance", "1e-12"], folder, 60)
        if code != 0:
            problems.append(f"suffuse-post ledger: {output.strip()[-600:]}")
    leftovers = [path.name for path in folder.iterdir() if path.name not in ("case.h5", PIPE, results.name)]
    if leftovers:
        problems.append(f"left {', '.join(sorted(leftovers))}")
    return problems, spent


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", required=True, type=pathlib.Path, help="folder of the programs")
    parser.add_argument("--group", choices=sorted(GROUPS), help="run the cases of one group")
    parser.add_argument("--markdown", action="store_true", help="print a table instead of lines")
    parser.add_argument("names", nargs="*", help="run these cases alone")
    arguments = parser.parse_args()
    cases = read_cases()
    unknown = set(arguments.names) - {case["case"] for case in cases}
    if unknown:
        parser.error(f"no such case: {', '.join(sorted(unknown))}")
    chosen = [case for case in cases if (not arguments.names or case["case"] in arguments.names)
              and (not arguments.group or case["group"] == arguments.group)]
    failed = 0
    if arguments.markdown:
        print("| case | before | now: exit code | says | processor time, s |\n|---|---|---|---|---|")
    for case in chosen:
        folder = pathlib.Path(tempfile.mkdtemp(prefix="suffuse-case-"))
        os.mkfifo(folder / PIPE)
        problems, spent = problems_of(case, arguments.bin.resolve(), folder)
        shutil.rmtree(folder)
        failed += bool(problems)
        if arguments.markdown:
            end = f"failed: {'; '.join(problems)}" if problems else case["exit"]
            print(f"| {case['case']} | {case['was']} | {end} | {case['says']} | {spent:.1f} |".replace("\n", " "))
        else:
            print(f"{case['case']}: {'failed' if problems else 'as expected'}, {spent:.1f} s")
            for problem in problems:
                print(f"  {problem}")
        sys.stdout.flush()
    print(f"{len(chosen) - failed} passed, {failed} failed", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

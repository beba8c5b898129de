#!/usr/bin/python3
"""Meshes a scene again and again until its discharge is known to mesh.error:

    adapt.py [--over-run | --by-default] PROGRAMS SCENE STEM [--set KEY=VALUE]...

Looks at the steady flow at the start of the scene. With --over-run it makes the run on each mesh and looks at the whole of it;
STEM.results/ is that on the last mesh. --by-default is for a scene without mesh.error: where the mesher says that it has chosen
mesh.size, mesh.error is 0.01, and what cannot be bounded or met stays as it is.

Makes STEM.case.h5, and STEM.adapt.csv with a row for each mesh. With KEEP_MESHES=1 in the environment every case stays, as
STEM-NUMBER.case.h5. Exit codes are those of the programs; 3 also if mesh.max_elements is
not enough, or more elements hardly help: an estimate may hold more than the error of the mesh.
"""

import atexit
import os
import re
import shutil
import subprocess
import sys

MOST_MESHES = 20
mode = sys.argv.pop(1) if sys.argv[1].startswith("--") else ""
programs, scene, stem, *changes = sys.argv[1:]
sizes = f"{stem}.sizes.h5"
atexit.register(lambda: os.path.exists(sizes) and os.unlink(sizes))


def run(program, *arguments):
    return subprocess.run([f"{programs}/{program}", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def mesh(*options):
    """Makes the case; what the mesher says of it."""
    made = run("suffuse-mesher", scene, *changes, *options, "-o", f"{stem}.case.h5")
    print(made.stderr, end="", file=sys.stderr, flush=True)
    if made.returncode:
        sys.exit(made.returncode)
    return made.stdout


def measure():
    """How well the discharge is known on this mesh."""
    start = []
    if mode == "--over-run":
        ended = run("suffuse-solver", f"{stem}.case.h5", "-o", f"{stem}.results", "--force", "--quiet")
        if ended.returncode:
            return ended
        start = ["--from", f"{stem}.results"]
    return run("suffuse-solver", f"{stem}.case.h5", "--sizes", sizes, *start)


def hardly_helped(meshes):
    """Whether the last mesh has at least twice as many elements as an earlier one, and leaves 85 % of the interval or more."""
    elements, width = meshes[-1]
    return any(width > 0.85 * earlier_width for earlier, earlier_width in [pair for pair in meshes if 2 * pair[0] <= elements][-1:])


def adapt():
    """Exit code, message, what the mesher says of the last mesh."""
    said, meshes = mesh(), []
    if mode == "--by-default" and "mesh again until" not in said:
        return 0, "", said
    with open(f"{stem}.adapt.csv", "w", encoding="utf-8") as table:
        print("elements,flux_out,flux_out_low,flux_out_high", file=table)
        for count in range(1, MOST_MESHES + 1):
            if os.environ.get("KEEP_MESHES"):
                shutil.copy(f"{stem}.case.h5", f"{stem}-{count}.case.h5")
            measured = measure()
            if measured.returncode:
                return measured.returncode, measured.stderr.strip("\n"), said
            answer = measured.stdout.strip("\n")
            print(measured.stderr, end="", file=sys.stderr, flush=True)
            print(f"mesh {count}: {answer}", flush=True)
            for q, low, high, elements in re.findall(r"^Q = (\S*) .*between (\S*) and (\S*) .*, (\d*) elements$", answer, re.M):
                print(elements, q, low, high, sep=",", file=table, flush=True)
                meshes.append((int(elements), float(high) - float(low)))
            first = mode == "--by-default" and count == 1
            if first:  # the key makes the run say how well its discharge is known
                changes.extend(["--set", "mesh.error=0.01"])
            if " is met" in answer:
                return 0, "", mesh() if first else said
            if " is not met: mesh again" not in answer:
                return 3, answer.splitlines()[-1], said
            if hardly_helped(meshes):
                return 3, "mesh.error is not met, and more elements hardly help: the case has the last mesh", said
            said = mesh("--sizes", sizes)
    return 3, f"mesh.error is not met after {MOST_MESHES} meshes", said


code, message, said = adapt()
if mode == "--by-default" and code in (2, 3):  # what is not met by default is no failure
    print("not meshed again:", message.removeprefix("suffuse-solver: error: "))
    code = 0
elif message:
    print(message, file=sys.stderr)
if code == 0:
    print(said, end="")
sys.exit(code)

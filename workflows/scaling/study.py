#!/usr/bin/python3
"""The cost of each stage of the pipeline for columns of any size, what soil that moves costs, and what two ranks gain.

    study.py measure PROGRAMS MODE-ELEMENTS-THREADS STEM    writes STEM.csv, a header and one line
    study.py report FILE.csv...                             prints the tables of the document
    study.py motion PROGRAMS OUT                            prints the table of soil that moves
    study.py ranks PROGRAMS SCENE.toml OUT                  prints the table of ranks: linear systems of the flow of up to a
                                                            million faces, the bandwidth of the machine, whole explicit steps

PROGRAMS is the folder of the programs, SCENE the basin of the tests. ROWS=N takes systems of N rows alone. Stages that take less
than a few seconds are repeated, and the median is taken.
"""

import math
import os
import pathlib
import re
import shutil
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(1, str(here.parent))
from common import call, markdown, median, pass_seconds, power, read_rows, run_json, set_options, timed

SMALL = 4.0
STAGES = ("mesher", "ledger", "picture", "solver")
PASSES = {"passes": "", "flow": "(flow|exchange)", "movement": "(transport|movement)", "erosion": "erosion", "coefficients": "(water|coefficients)"}


def changes_of(mode, elements):
    """What a mode changes of the scene. Explicit steps are nine tenths of the stability limit, which is proportional to the
    size of an element; in implicit steps the liquid passes a tenth of an element."""
    size = 1 / int(math.sqrt(elements / 2) + 0.5)  # two triangles per square of the unit column
    steps, per_size, how = 200 if elements <= 2e4 else 50 if elements <= 2e5 else 20, 3.5e-3, 'scheme="explicit"'
    changes = []
    if mode.endswith("-implicit"):
        steps, per_size, how = 20, 2.0, "inertia=false"
        # Permeability changes with porosity, so the flow is solved in every step.
        changes = ["soil.specimen.conductivity_law=kozeny-carman"]
    if mode.startswith("dp-"):
        changes += ["formulation=double-point", "points.solid_per_element=1", "points.liquid_per_element=12"]
    if mode in ("dp-material-point", "dp-mixed"):
        changes += [f"flow.integration={mode[3:]}"]
    step, end = f"{per_size * size:.6g}", f"{steps * per_size * size:.6g}"
    return [f"name={mode}", f"mesh.size={size:.17g}", f"time={{{how},step={step},end={end}}}", f"output.every={end}", *changes]


def once(programs, stem, changes, threads):
    """Seconds of each stage and pass in one run through the pipeline."""
    case, results = f"{stem}.case.h5", f"{stem}.results"
    mesher, _ = timed(programs / "suffuse-mesher", here / "column.toml", *set_options(changes), "-o", case)
    solver, _ = timed(programs / "suffuse-solver", case, "-o", results, "--force", "--threads", threads, "--quiet")
    ledger, _ = timed(programs / "suffuse-post", "ledger", results)
    picture, _ = timed(programs / "suffuse-post", "render", results, "--field", "porosity", "-o", f"{stem}.png")
    run = run_json(results)
    return [*(f"{seconds:.4f}" for seconds in (mesher, ledger, picture, solver)), *(pass_seconds(run, name) for name in PASSES.values())]


def measure(programs, name, stem):
    mode, elements, threads = name.rsplit("-", 2)
    changes = changes_of(mode, float(elements))
    lines = [once(pathlib.Path(programs), stem, changes, threads)]
    if sum(map(float, lines[0][: len(STAGES)])) < SMALL:
        lines += [once(pathlib.Path(programs), stem, changes, threads) for _ in range(4)]
    run = run_json(f"{stem}.results")
    row = {"mode": mode, "threads": threads, **{key: run[key] for key in ("elements", "solid_points", "liquid_points", "steps")},
           "memory": run["memory_bytes"], "case_bytes": os.path.getsize(f"{stem}.case.h5"), **dict(zip([*STAGES, *PASSES], map(median, zip(*lines))))}
    pathlib.Path(f"{stem}.csv").write_text(f"{','.join(row)}\n{','.join(map(str, row.values()))}\n", encoding="utf-8")
    shutil.rmtree(f"{stem}.results")
    for made in (f"{stem}.case.h5", f"{stem}.png"):
        os.unlink(made)


# --- Tables ------------------------------------------------------------------------------------------------


def points_of(row):
    """Solid points in single-point runs, liquid points in double-point ones."""
    return row["liquid_points"] or row["solid_points"]


def exponent(rows, cost):
    """The exponent b of cost = a points^b, by least squares, from 1e4 points on."""
    found = power([(points_of(row), row[cost] / row["steps"]) for row in rows if points_of(row) >= 0.9e4 and row[cost] > 0])
    return "-" if found is None else f"{found:.2f}"


def report(*files):
    rows = [{name: text if name == "mode" else float(text) for name, text in row.items()} for file in files for row in read_rows(file)]
    for row in rows:  # columns are rounded to squares: the power of ten names them
        row["power"] = int(math.log10(row["elements"]) + 0.5)
    runs = {(row["mode"], row["power"], row["threads"]): row for row in rows}
    powers, modes = sorted({row["power"] for row in rows}), list(dict.fromkeys(row["mode"] for row in rows))

    def table(cell, cost=None):
        """A row per mode, a column per size; costs get their exponent."""
        lines = []
        for mode in modes:
            found = [(runs.get((mode, power, 1)), runs.get((mode, power, 2))) for power in powers]
            lines.append([mode, *(cell(*pair) if pair[0] else "" for pair in found)])
            lines[-1] += [exponent([one for one, _ in found if one], cost)] if cost else []
        print(markdown(["mode", *(f"10<sup>{power}</sup>" for power in powers), *["exponent"] * bool(cost)], lines))

    cost_of = lambda name: lambda one, two: f"{1e9 * one[name] / (one['steps'] * points_of(one)):.1f}"
    print("Nanoseconds per point and step of the flow, everything in the step loop, one thread; meshes of so many elements:\n")
    table(cost_of("passes"), "passes")
    print("Of it, the flow (implicit: with its linear systems):\n")
    table(cost_of("flow"), "flow")
    print("How many times faster two threads are (step loop):\n")
    table(lambda one, two: f"{one['passes'] / one['steps'] / (two['passes'] / two['steps']):.2f}" if two else "")
    print("Peak memory of the solver, bytes per point:\n")
    table(lambda one, two: f"{one['memory'] / points_of(one):.0f}")
    print("The pipeline by stage, one thread, s of wall time:\n")
    lines = [[mode, *(f"{number:.0f}" for number in (row["elements"], points_of(row), row["steps"])),
              *(f"{row[name]:.2f}" for name in ("mesher", "solver", "passes", "ledger", "picture")), f"{row['case_bytes'] / 1e6:.3g}"]
             for mode in modes for power in powers if (row := runs.get((mode, power, 1)))]
    print(markdown(["mode", "elements", "points", "steps", "mesher", "solver", "of it steps", "ledger", "picture", "case, MB"], lines), end="")


# --- Soil that moves ---------------------------------------------------------------------------------------

TESTS = here.parent.parent / "tests" / "cases"
EXAMPLES = here.parent / "examples"
SQUARES = (8, 16)
SLOPES = (1.0, 0.5)


def motion(programs, out):
    programs, case, results = pathlib.Path(programs), f"{out}/motion.case.h5", f"{out}/motion.results"
    mesh = lambda scene, changes: call(programs / "suffuse-mesher", scene, *set_options(changes), "-o", case)
    runs = []
    for squares in SQUARES:
        drawing = pathlib.Path(out, f"sand-{squares}.geo").resolve()
        text = re.sub("squares = .*;", f"squares = {squares};", (here / "sand.geo").read_text(encoding="utf-8"), count=1)
        drawing.write_text(text, encoding="utf-8")
        runs.append((f"dry sand runs out, {squares} crossed squares over its width, to its rest", TESTS / "sand-column.toml", [f'geometry.file="{drawing}"']))
    runs.append(("a levee loses fines, fails, slides and rests", EXAMPLES / "slide" / "slide.toml", []))
    lines = []
    for name, scene, changes in runs:
        mesh(scene, changes)
        call(programs / "suffuse-solver", case, "-o", results, "--force", "--threads", 1, "--quiet")
        run = run_json(results)
        points, seconds = int(run["solid_points"]), float(run["wall_seconds"])
        lines.append([name, run["elements"], points, run["steps"], read_rows(f"{results}/history.csv")[-1]["newton_iterations"], f"{seconds:.3g}",
                      f"{1e6 * seconds / points / int(run['steps']):.3g}", f"{int(run['memory_bytes']) / points:.0f}"])
        shutil.rmtree(results)
    print(markdown(["run", "elements", "points", "steps", "iterations", "s", "µs per point and step", "bytes per point"], lines))
    lines = []
    for size in SLOPES:
        mesh(EXAMPLES / "slope" / "slope.toml", [f"mesh.size={size}"])
        seconds, _ = timed(programs / "suffuse-solver", case, "--strength-reduction", "--threads", 1, "--quiet", "-o", f"{out}/factor.csv")
        found = read_rows(f"{out}/factor.csv")[-1]
        lines.append([f"{size} m", f"{float(found['factor']):.3f}", found["trials"], found["iterations"], f"{seconds:.3g}"])
    print(markdown(["slope, elements of", "factor", "trials", "iterations", "s"], lines), end="")
    os.unlink(case)


# --- Ranks -------------------------------------------------------------------------------------------------


def systems(programs, ranks):
    """The rows that ranks_bench prints, and the bandwidth."""
    said = call("mpirun", "-q", "--bind-to", "none", "-n", ranks, programs / "ranks_bench", *os.environ.get("ROWS", "").split()).stdout
    lines = said.splitlines()
    triad = next(float(line.split()[5]) for line in lines if line.startswith("# triad"))
    return [line.split(",") for line in lines if line and not line.startswith(("#", "ranks"))], triad


def ranks(programs, scene, out):
    programs, scene, out = map(pathlib.Path, (programs, scene, out))
    os.environ |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    (alone, triad), (shared, triad_of_two) = (systems(programs, count) for count in (1, 2))
    for file in scene.parent.glob("*.geo"):
        shutil.copy(file, out)
    keys = [f"mesh.size={os.environ.get('SIZE', '0.0044')}", "time.end=1e-3", "output.every=1e-3", "output.snapshot_every=1e-3"]
    call(programs / "suffuse-mesher", scene, *set_options(keys), "-o", out / "basin.case.h5")
    said = call(programs / "suffuse-solver", out / "basin.case.h5", "--explain", "--ranks", 2).stdout
    lines = []
    for one, two in zip(alone, shared):
        setup, each, setup_of_two, each_of_two = (float(row[k]) for row in (one, two) for k in (5, 6))
        lines.append([f"{two[1]}D", f"{float(two[2]):.3g}", f"{float(two[3]):.0e}", one[4], two[4], f"{1e3 * setup:.3g}",
                      f"{setup / setup_of_two:.2f}", f"{1e3 * each:.3g}", f"{each / each_of_two:.2f}"])
    print(f"Bandwidth of two ranks over that of one: {triad_of_two / triad:.2f}.\n")
    print(markdown(["", "rows", "contrast", "iterations, 1 rank", "2 ranks", "set-up, ms", "gain", "iteration, ms", "gain"], lines))
    print("\n".join(line for line in said.splitlines() if line.startswith("trial")))


if __name__ == "__main__":
    {"measure": measure, "report": report, "motion": motion, "ranks": ranks}[sys.argv[1]](*sys.argv[2:])

#!/usr/bin/python3
"""A study of convergence in OUT/convergence/NAME/. make calls it, with its variables in the environment and itself as MAKE. The
runs are a sweep over mesh.size and time.tolerance, in the folder runs/.

Writes table.csv, the sweep's table, convergence.csv, report.md and charts. Exit codes: 2 for wrong input; 1 if the runs are not all
done.
"""

import json
import os
import pathlib
import re
import sys
import tempfile

workflows = pathlib.Path(__file__).resolve().parent.parent
sys.path[1:1] = [str(workflows), str(workflows / "sweep")]
from assessment import table_in
from chart import draw
from common import (InputError, NotDone, cell, consult, csv_text, end_with, find_file, folder_of, number_of, problem, programs_of,
                    read_rows, read_scene, set_options, write_changed, wrong)
from outputs import outputs_of, unit_of, words_of
from richardson import NEGLIGIBLE, ORDERS_OF_SIZE, ORDERS_OF_TOLERANCE, Estimate, estimate
from sweep import make

DEFAULT_OUTPUTS = "fines_lost,flux_out"
DEFAULT_TOLERANCE = 1e-3
LARGEST_TOLERANCE = 0.1
SIZE, TOLERANCE, INERTIA = "mesh.size", "time.tolerance", "time.inertia"
# The ratio of sizes that the numbers of elements say may differ by this factor from that of mesh.size.
FOLLOWS = 0.75
# Share of the difference between the two finest sizes above which irregular errors in time disturb the order in space.
DISTURBING = 0.3


# --- What is asked for ------------------------------------------------------------------------------------


def asked_numbers(variable, largest):
    """The numbers of a variable of make, largest first; none if it is empty."""
    texts = [text.strip() for text in os.environ.get(variable, "").split(",") if text.strip()]
    if not texts:
        return []
    numbers = [number_of(text) for text in texts]
    for text, number in zip(texts, numbers):
        if number is None or not 0.0 < number <= largest:
            bound = "" if largest == float("inf") else f" up to {largest:g}"
            raise wrong(variable, "", f"'{text}'", f"numbers above 0{bound} with commas between them")
    if len(set(numbers)) < 3 or len(set(numbers)) < len(numbers):
        raise wrong(variable, "", f"'{','.join(texts)}'", "at least three different numbers")
    return sorted(numbers, reverse=True)


def asked_outputs():
    names = [name.strip() for name in (os.environ.get("OUTPUTS") or DEFAULT_OUTPUTS).split(",") if name.strip()]
    repeated = [name for name in names if names.count(name) > 1]
    if repeated or not names:
        found = f"'{repeated[0]}' twice" if repeated else "nothing"
        raise wrong("OUTPUTS", "", found, "different names with commas between them")
    return names


def refuse_fixed_meshes(path, scene):
    file = str(scene["geometry"].get("file", ""))
    if file.lower().endswith(".msh"):
        raise wrong(path, "geometry.file", f"'{file}', a mesh whose elements have their sizes",
                    "a shape, or a .geo or .step file, whose elements follow mesh.size")
    if "error" in scene["mesh"]:
        raise wrong(path, "mesh.error", str(scene["mesh"]["error"]),
                    "a scene without this key: with it the sizes of elements do not follow mesh.size")


# --- Meshes ----------------------------------------------------------------------------------------------


def mesh(programs, scene, size):
    """What the mesher says of the mesh of a size, or of the scene's own mesh if `size` is None."""
    with tempfile.TemporaryDirectory() as scratch:
        change = [] if size is None else set_options([f"{SIZE}={size:.10g}"])
        try:
            made = consult(programs / "suffuse-mesher", scene, *change, "-o", f"{scratch}/mesh.case.h5")
        except InputError as error:
            raise InputError([f"The mesh of {SIZE} = {size:g} cannot be made."] * (size is not None) + [str(error)]) from None
    return made.stdout + made.stderr


def elements_of(said):
    return int(re.search(r"^ *elements +(\d+)", said, re.M)[1])


def dimension_of(said):
    return 3 if re.search(r"^ *region .* m3$", said, re.M) else 2


def sizes_of(path, scene, programs):
    """The sizes of the study, largest first, and the size of the runs whose tolerance varies."""
    asked = asked_numbers("SIZES", float("inf"))
    own = scene["mesh"].get("size")
    if own is not None and not (isinstance(own, (int, float)) and own > 0):
        mesh(programs, path, None)
        raise wrong(path, SIZE, str(own), "a number above 0")
    if asked:
        return asked, float(own) if own in asked else asked[0]
    if own is not None:
        return [2.0 * own, float(own), 0.5 * own, 0.25 * own], float(own)
    # The mesher then chooses a size that makes many elements, so it is the finest of the study.
    default = re.search(r"mesh\.size was not given: (\S+) m", mesh(programs, path, None))
    if not default:
        raise wrong(path, SIZE, "no such key, and a file with sizes of its own",
                    "mesh.size in the scene, or SIZES=A,B,C below the sizes of the file")
    finest = float(default[1])
    return [4.0 * finest, 2.0 * finest, finest], 4.0 * finest


def refuse_own_sizes(path, scene, programs, sizes):
    """Throws InputError if the mesh does not follow mesh.size. Meshes the two coarsest sizes."""
    coarse, fine = mesh(programs, path, sizes[0]), mesh(programs, path, sizes[1])
    found = (elements_of(fine) / elements_of(coarse)) ** (1.0 / dimension_of(fine))
    if "shape" in scene["geometry"] or found >= FOLLOWS * sizes[0] / sizes[1]:
        return
    file = scene["geometry"].get("file", "the file")
    raise InputError([
        problem(path, SIZE, f"{elements_of(coarse)} elements with {sizes[0]:g} m and {elements_of(fine)} with {sizes[1]:g} m",
                f"elements that become finer by {sizes[0] / sizes[1]:.3g}, as {SIZE} does"),
        f"{file} gives sizes of its own, or has edges shorter than the size; {SIZE} is only the largest size of its elements.",
        f"Leave the fourth number of its points out (Point(1) = {{0, 0, 0}};), so that {SIZE} holds, and remove its size fields; or give",
        "SIZES=A,B,C that are smaller than all sizes and edges of the file.",
    ])


# --- The table of the sweep ----------------------------------------------------------------------------------


def tolerances_of(path, scene):
    """The tolerances of the study, largest first, and that of the runs whose size varies; none if steps do not follow it."""
    time = scene["time"]
    asked = asked_numbers("TOLERANCES", LARGEST_TOLERANCE)
    if "step" in time or time.get("scheme") == "explicit":
        if asked:
            found = "time.step" if "step" in time else 'time.scheme = "explicit"'
            raise wrong("TOLERANCES", "", f"numbers, and a scene with {found}", "a scene whose steps follow time.tolerance")
        return [], None
    own = time.get("tolerance", DEFAULT_TOLERANCE)
    if not isinstance(own, float) or not 0.0 < own <= LARGEST_TOLERANCE:
        raise wrong(path, TOLERANCE, str(own), f"a number above 0 up to {LARGEST_TOLERANCE:g}")
    if asked:
        return asked, own if own in asked else asked[1]
    factors = (4.0, 1.0, 0.25) if 4.0 * own <= LARGEST_TOLERANCE else (1.0, 0.25, 0.0625)
    return [own * factor for factor in factors], own


def inertia_of(folder):
    """The value "false" of time.inertia if the coarsest run leaves it out; otherwise empty.

    Where the solver keeps the inertia by its own decision, it does not follow short waves, as it would with "true".
    """
    try:
        plan = json.loads((folder / "runs/0001/0001.results/run.json").read_text(encoding="utf-8"))["plan"]
    except (OSError, ValueError, KeyError):
        return ""
    return "false" if any(line.startswith("skip: inertia of the liquid") for line in plan) else ""


def table_of(sizes, fixed_size, tolerances, fixed_tolerance, inertia):
    """Rows of sizes at a fixed tolerance, then of tolerances at a fixed size.

    The solver decides by time.tolerance whether the liquid has inertia. All runs must solve the same equations, so
    those of other tolerances leave it out if the coarsest run does.
    """
    text = "{:.10g}".format
    if not tolerances:
        return [[SIZE], *([text(size)] for size in sizes)]
    rows = [[text(size), text(fixed_tolerance), ""] for size in sizes]
    rows += [[text(fixed_size), text(tolerance), inertia] for tolerance in tolerances if tolerance != fixed_tolerance]
    return [[SIZE, TOLERANCE, INERTIA], *rows] if inertia else [[SIZE, TOLERANCE], *(row[:2] for row in rows)]


def prepare(path, folder, programs, first):
    asked_outputs()
    content = read_scene(path)
    scene = {name: table_in(content, name) for name in ("geometry", "mesh", "time")}
    refuse_fixed_meshes(path, scene)
    tolerances, fixed_tolerance = tolerances_of(path, scene)
    sizes, fixed_size = sizes_of(path, scene, programs)
    refuse_own_sizes(path, scene, programs, sizes)
    inertia = "" if "inertia" in scene["time"] else inertia_of(folder)
    rows = table_of(sizes, fixed_size, tolerances, fixed_tolerance, inertia)
    folder.mkdir(parents=True, exist_ok=True)
    write_changed(folder / "table.csv", csv_text(rows[:2] if first else rows))
    plan = {"sizes": sizes, "fixed_size": fixed_size, "tolerances": tolerances, "fixed_tolerance": fixed_tolerance,
            "shape": "shape" in scene["geometry"]}
    (folder / "plan.json").write_text(json.dumps(plan), encoding="utf-8")


# --- Runs ----------------------------------------------------------------------------------------------------


def with_results(folder, row):
    """A row of sweep.csv, with what is in the results of the run."""
    results = folder / "runs" / row["run"] / f"{row['run']}.results"
    info = json.loads((results / "run.json").read_text(encoding="utf-8"))
    return row | {"outputs": outputs_of(results, row), "info": info, "results": results}


def runs_of(folder):
    rows = read_rows(folder / "runs" / "sweep.csv")
    bad = [row for row in rows if row["status"] != "done"]
    if bad:
        raise NotDone(["The study needs all its runs, and these are not done. Mend what their messages say, give other SIZES= or "
                          "TOLERANCES=, or call make again."]
                         + [f"{row['run']}: {SIZE} = {row[SIZE]}: {row['status']}: {row['message']}" for row in bad])
    return [with_results(folder, row) for row in rows]


def check_outputs(names, run):
    known = [name for name, value in run["outputs"].items() if number_of(value) is not None]
    unknown = [name for name in names if name not in known]
    if unknown:
        raise InputError([problem("OUTPUTS", "", f"'{name}'", "one of " + ", ".join(known), known) for name in unknown])


# --- Estimates ----------------------------------------------------------------------------------------------


class Series:
    """Runs of one key, the coarsest first, and the lengths that stand for it in ratios."""

    def __init__(self, key, numbers, runs, lengths, orders):
        self.key, self.numbers, self.runs, self.lengths, self.orders = key, numbers, runs, lengths, orders
        self.unit = " m" if key == SIZE else ""
        self.word = "sizes" if key == SIZE else "tolerances"
        self.switches = switches(runs)

    def values(self, name):
        return [number_of(run["outputs"].get(name)) for run in self.runs]

    def estimate(self, name):
        found = estimate(self.lengths, self.values(name), self.orders)
        return Estimate("switch") if self.switches and found.kind != "constant" else found


def switches(runs):
    """Passes of the plan that some runs make and others skip: their models differ."""
    plans = [{re.split("[,;]", line)[0] for line in run["info"].get("plan", [])} for run in runs]
    words = [{line.partition(": ")[2] for line in plan if line.startswith("run: ")} for plan in plans]
    return sorted(set.union(*words) - set.intersection(*words)) if words else []


def series_of(plan, runs):
    """The series of sizes, and that of tolerances or None."""

    def run_of(size, tolerance):
        for run in runs:
            if float(run[SIZE]) == size and (tolerance is None or float(run[TOLERANCE]) == tolerance):
                return run
        raise InputError([f"The run of {SIZE} = {size:g} is missing; call make again."])

    rounded = lambda number: None if number is None else float(f"{number:.10g}")
    sizes, tolerances = [rounded(size) for size in plan["sizes"]], [rounded(number) for number in plan["tolerances"]]
    fixed_size, fixed_tolerance = rounded(plan["fixed_size"]), rounded(plan["fixed_tolerance"])
    of_size = [run_of(size, fixed_tolerance) for size in sizes]
    space = Series(SIZE, sizes, of_size, lengths_of(plan, sizes, of_size), ORDERS_OF_SIZE)
    if not tolerances:
        return space, None
    of_tolerance = [run_of(fixed_size, tolerance) for tolerance in tolerances]
    return space, Series(TOLERANCE, tolerances, of_tolerance, tolerances, ORDERS_OF_TOLERANCE)


def lengths_of(plan, sizes, runs):
    """Mean sizes of elements by their number, up to a factor, as Celik asks; of a shape too thin for that mesh.size."""
    dimension = runs[0]["info"]["dimension"]
    lengths = [run["info"]["elements"] ** (-1.0 / dimension) for run in runs]
    for k in range(len(sizes) - 1):
        wanted, found = sizes[k] / sizes[k + 1], lengths[k] / lengths[k + 1]
        if FOLLOWS <= found / wanted <= 1.0 / FOLLOWS:
            continue
        if plan["shape"]:
            return sizes
        raise InputError([problem(SIZE, "", f"{runs[k]['info']['elements']} elements with {sizes[k]:g} m and "
                                  f"{runs[k + 1]['info']['elements']} with {sizes[k + 1]:g} m",
                                  f"elements that become finer by {wanted:.3g}, as {SIZE} does"),
                          "The geometry file gives sizes of its own, or has edges shorter than the size. Give other SIZES=."])
    return lengths


# --- Sentences -----------------------------------------------------------------------------------------------


def listed(numbers, unit=""):
    texts = [f"{number:g}" for number in numbers]
    return (", ".join(texts[:-1]) + " and " + texts[-1] if len(texts) > 1 else texts[0]) + unit


def percent(share):
    return f"{100.0 * share:.2g} %" if share >= 1e-10 else "less than 1e-8 %"


def shown(value, unit, digits):
    return f"{value:.{digits}g}" + (f" {unit}" if unit not in ("", "-") else "")


def digits_of(values):
    """Digits with which the values of a series differ."""
    spread, largest = max(values) - min(values), max(abs(value) for value in values)
    if spread <= NEGLIGIBLE * largest:
        return 4
    return next((digits for digits in range(4, 13) if spread >= 20.0 * largest * 10.0**-digits), 12)


def why_not(found, series):
    if found.kind == "order":
        order = "infinite" if found.order == float("inf") else f"{found.order:.2g}"
        return f"The observed order is {order}, outside {series.orders[0]:g} to {series.orders[1]:g}."
    return {
        "oscillating": "The differences between them change their sign.",
        "diverging": f"The differences between them do not fall as the {series.word} do.",
        "switch": "The runs do not solve the same equations.",
        "disturbed": f"The differences between them are as small as those between values of {TOLERANCE}, which are irregular.",
        "index": "The grid convergence index does not fall with the observed order.",
        "zero": "The finest of them is 0, so there is no share of it.",
    }[found.kind]


def not_in_range(found, series, values):
    largest = max(abs(value) for value in values)
    texts = [f"{value:.{digits_of(values)}g}" for value in values]
    return (f"On the {series.word} {listed(series.numbers, series.unit)} the values are {', '.join(texts[:-1])} and {texts[-1]}; they "
            f"differ by up to {percent((max(values) - min(values)) / largest)}. {why_not(found, series)} This series is not in its range "
            "of convergence, so there is no extrapolated value and no index.")


def switch_sentence(series):
    return (f"The runs on the {series.word} {listed(series.numbers, series.unit)} do not solve the same equations: the solver "
            f"includes {' and '.join(series.switches)} in some of them and not in others. Other {series.word.upper()}= avoid this.")


def space_sentences(name, unit, series, values, found):
    size, digits = series.numbers[-1], max(5, digits_of(values))
    start = f"The {words_of(name)} is {shown(values[-1], unit, digits)}"
    if found.kind == "constant":
        return [f"{start} with all sizes: {listed(series.numbers, series.unit)}."]
    if not found.in_range:
        return [f"{start} on elements of {size:g} m.", not_in_range(found, series, values)]
    return [f"{start} on elements of {size:g} m; its grid convergence index is {percent(found.index)} (observed order "
            f"{found.order:.2f} on the sizes {listed(series.numbers[-3:], series.unit)}), and its extrapolated value is "
            f"{shown(found.extrapolated, unit, digits)}."]


def time_sentences(plan, series, values, found):
    if found.kind == "constant":
        return [f"It does not depend on {TOLERANCE} ({listed(series.numbers)})."]
    if not found.in_range:
        return [not_in_range(found, series, values)]
    return [f"The index of {TOLERANCE} is {percent(found.index)} at {series.numbers[-1]:g} (observed order {found.order:.2f} on "
            f"the tolerances {listed(series.numbers[-3:])}, with elements of {plan['fixed_size']:g} m)."]


def disturbed(space_values, time_values, found_in_time):
    """Whether irregular errors in time, which differ from run to run, are as large as the differences between sizes."""
    scatter = max(time_values) - min(time_values)
    return not found_in_time.in_range and scatter > DISTURBING * abs(space_values[-1] - space_values[-2])


# --- Tables and report ---------------------------------------------------------------------------------------


def row_of(name, unit, space, time, found, found_in_time):
    row = {"output": name, "unit": unit}
    for series in (space, time):
        if series:
            row |= {f"{series.key} {number:g}": cell(value) for number, value in zip(series.numbers, series.values(name))}
    row |= {"order": cell(found.order), "extrapolated": cell(found.extrapolated), "gci_space_percent": cell(100.0 * found.index),
            "in_range": "yes" if found.in_range else "no", "said_of_sizes": found.kind}
    if time:
        row |= {"order_time": cell(found_in_time.order), "gci_time_percent": cell(100.0 * found_in_time.index),
                "in_range_time": "yes" if found_in_time.in_range else "no", "said_of_tolerances": found_in_time.kind}
    return row


def paragraph_of(plan, name, unit, space, time, found, found_in_time):
    values = space.values(name)
    sentences = space_sentences(name, unit, space, values, found)
    if time:
        sentences += time_sentences(plan, time, time.values(name), found_in_time)
    return " ".join(sentences)


def conclude(folder, programs):
    plan = json.loads((folder / "plan.json").read_text(encoding="utf-8"))
    names = asked_outputs()
    runs = runs_of(folder)
    for run in runs:
        check_outputs(names, run)
    space, time = series_of(plan, runs)
    rows, paragraphs = [], []
    for name in names:
        unit = unit_of(name, runs[0]["info"]["dimension"])
        found_in_time = time.estimate(name) if time else None
        found = space.estimate(name)
        if time and disturbed(space.values(name), time.values(name), found_in_time) and found.kind == "in range":
            found = Estimate("disturbed", found.order)
        rows.append(row_of(name, unit, space, time, found, found_in_time))
        paragraphs.append(paragraph_of(plan, name, unit, space, time, found, found_in_time))
        draw(folder, name, unit, space, found, programs)
    if not time:
        paragraphs.append(f"The error in time is not estimated: the steps of this scene do not follow {TOLERANCE}.")
    paragraphs += [switch_sentence(series) for series in (space, time) if series and series.switches]
    report = "\n\n".join(paragraphs) + "\n"
    write_changed(folder / "convergence.csv", csv_text([list(rows[0]), *([row[key] for key in rows[0]] for row in rows)]))
    write_changed(folder / "report.md", report)
    print(f"\n{report}\nTable, report and charts are in {folder.resolve()}")


def work():
    scene, programs = find_file("SCENE"), programs_of()
    folder = folder_of("convergence", scene)
    # The coarsest run shows which outputs there are, before the others cost time.
    for first in ([] if (folder / "runs/sweep.csv").is_file() else [True]) + [False]:
        if not first:
            run, *_ = read_rows(folder / "runs/sweep.csv")
            if run["status"] == "done":
                check_outputs(asked_outputs(), with_results(folder, run))
        prepare(scene, folder, programs, first)
        code = make(scene, folder.resolve() / "table.csv", folder / "runs")
        if code:
            return code
    return conclude(folder, programs)


if __name__ == "__main__":
    end_with("convergence.py: ", work)

#!/usr/bin/env python3
"""Meshes of ten sections of steady flow: adapted, uniform, graded by hand.

    study.py PROGRAMS OUT [SECTION]...            writes OUT/meshes.csv, a row for each mesh, and OUT/table.md
    study.py --document PROGRAMS OUT DOCS         puts the table between the marks of the document, and draws its pictures

Exits with 3 if intervals of one section do not meet, if mesh.error is not met, or if the gap falls too slowly.
"""

import collections
import dataclasses
import math
import os
import re
import sys
from pathlib import Path

from scipy.special import ellipk

HERE = Path(__file__).resolve().parent
sys.path.insert(1, str(HERE.parent))
import svg
from common import call, csv_text, empty_folder, last_rows, markdown, power, put_between, read_rows, run_json, timed

ERRORS = (0.01, 0.001)
HALVINGS = 4
GRADING = 1 / 16  # size at corners, feet and ends over that elsewhere
MOST_UNIFORM = {2: 3e5, 3: 2e5}
ROUND_OFF = 1e-10
LEAST_SLOPE = -0.85
SHARE_OF_UNIFORM = 0.1


def discharge_under_base(half_width, depth):
    """q / (k h) under a flat base on a layer without ends (Harr 1962).

    Under the middle of the base the head is the mean of both. The half of the layer beside it is mapped
    to the half-plane by cosh(pi z / T): the four corners go to -1, 1, cosh(pi b / T) and infinity, whose
    cross-ratio is m.
    """
    m = math.tanh(math.pi * half_width / (2.0 * depth)) ** 2
    return float(ellipk(1.0 - m) / (2.0 * ellipk(m)))


# exact: the discharge, m3/s per m, where it is known; reaches: the least error that is expected within mesh.max_elements.
Section = collections.namedtuple("Section", "name words dimension exact reaches", defaults=(2, None, 0.001))
# Both layers end six times their depth from the pile or the dam, which changes the discharge by less than 1e-8.
SECTIONS = (
    Section("harr-dam", "dam with a flat base on a layer", exact=1e-4 * 2.0 * discharge_under_base(0.5, 1.0)),
    Section("sheet-pile", "sheet pile of half the depth", exact=1e-4 * 2.0 * 0.5),
    Section("pile-over-clay", "pile over a lens of clay"),
    Section("levee", "levee on layers"),
    Section("drain", "drain under a pond"),
    Section("disc", "flooded disc", dimension=3, reaches=0.01),
    Section("excavation", "excavation within walls", dimension=3, reaches=0.01),
    Section("bedded-weir", "weir on bedded ground"),
    Section("leaky-wall", "leaky wall"),
    Section("well", "pumped trench beside a river"),
)


@dataclasses.dataclass
class Mesh:
    """A mesh and what its flow says: the interval of the discharge, and wall times."""

    section: Section
    kind: str
    number: int
    low: float
    high: float
    elements: int
    seconds: float
    loop_seconds: float = None  # the last mesh of a loop has that of the loop; other meshes that of mesher and solver

    @property
    def middle(self):
        return 0.5 * (self.low + self.high)

    @property
    def gap(self):
        return self.high - self.low

    @property
    def error(self):
        """Half of the gap over the middle: what mesh.error limits."""
        return 0.5 * self.gap / abs(self.middle)


class Study:
    def __init__(self, programs, out):
        self.programs, self.out = Path(programs).resolve(), Path(out).resolve()
        self.out.mkdir(parents=True, exist_ok=True)
        self.meshes = []

    def solve(self, case):
        """Ends of the interval of the discharge, number of elements, wall time of the steady solution."""
        results = case.with_name("run.results")
        seconds, _ = timed(self.programs / "suffuse-solver", case, "-o", results, "--force", "--quiet")
        row = read_rows(results / "history.csv")[-1]
        interval = float(row["flux_out_low"]), float(row["flux_out_high"])
        if interval == (0.0, 0.0):
            interval = self.sum_of_outflows(results)
        elif float(row["flux_out_estimate"]) != 0.0:
            sys.exit(f"study.py: {case}: an estimate, no bound")
        return *interval, int(run_json(results)["elements"]), seconds

    @staticmethod
    def sum_of_outflows(results):
        """Where a boundary lets liquid in and out history.csv has no interval: the boundaries have."""
        rows = [row for row in last_rows(results / "boundaries.csv") if float(row["discharge"]) > 0.0]
        return tuple(sum(float(row[name]) for row in rows) for name in ("discharge_low", "discharge_high"))

    def adapt(self, section, error):
        folder = empty_folder(self.out / section.name / f"adapted-{error}")
        stem = folder / section.name
        seconds, done = timed(HERE.parent / "adapt.py", self.programs, HERE / f"{section.name}.toml", stem, "--set", f"mesh.error={error}",
                              ok=(0, 3), env=os.environ | {"KEEP_MESHES": "1"})
        (folder / "log").write_text(done.stdout + done.stderr, encoding="utf-8")
        if "error:" in done.stderr:
            sys.exit(f"study.py: {section.name}: {done.stderr}")
        for number, _ in enumerate(read_rows(f"{stem}.adapt.csv"), 1):
            case = folder / f"{section.name}-{number}.case.h5"
            self.meshes.append(Mesh(section, f"adapted to {error}", number, *self.solve(case)))
            case.unlink()
        self.meshes[-1].loop_seconds = seconds
        self.say(section, f"adapted to {error}")

    def halve(self, section, kind, grading):
        """The mesh of the scene, and meshes of half the sizes, a quarter and so on."""
        folder = empty_folder(self.out / section.name / kind)
        scene = (HERE / f"{section.name}.toml").read_text(encoding="utf-8")
        geometry = (HERE / f"{section.name}.geo").read_text(encoding="utf-8")
        start = float(re.search(r"^h = (.*);$", geometry, re.M).group(1))
        elements = 0
        for number in range(HALVINGS + 1):
            if elements * 2**section.dimension > MOST_UNIFORM[section.dimension]:
                break
            size = start / 2**number
            text = re.sub(r"^h = .*;$", f"h = {size!r};", geometry, flags=re.M)
            text = re.sub(r"^g = .*;$", f"g = {grading!r};", text, flags=re.M)
            (folder / f"{section.name}.geo").write_text(text, encoding="utf-8")
            (folder / f"{section.name}.toml").write_text(scene, encoding="utf-8")
            case = folder / f"{section.name}.case.h5"
            seconds, _ = timed(self.programs / "suffuse-mesher", folder / f"{section.name}.toml", "--set", f"mesh.size={size!r}", "-o", case)
            self.meshes.append(Mesh(section, kind, number + 1, *self.solve(case)))
            self.meshes[-1].loop_seconds = seconds + self.meshes[-1].seconds
            elements = self.meshes[-1].elements
            case.unlink()
        self.say(section, kind)

    def of(self, section, kind):
        return [m for m in self.meshes if m.section is section and m.kind == kind]

    def say(self, section, kind):
        steps = ", ".join(f"{m.elements} {100 * m.error:.2g} %" for m in self.of(section, kind))
        print(f"{section.name}, {kind}: {steps}", flush=True)

    def write_meshes(self):
        header = ["section", "kind", "mesh", "elements", "flux_out_low", "flux_out_high", "error", "exact", "solver_seconds", "loop_seconds"]
        rows = [[m.section.name, m.kind, m.number, m.elements, m.low, m.high, f"{m.error:.6g}", m.section.exact, f"{m.seconds:.3f}",
                 "" if m.loop_seconds is None else f"{m.loop_seconds:.3f}"] for m in self.meshes]
        (self.out / "meshes.csv").write_text(csv_text([header, *rows]), encoding="utf-8")


class Family:
    """A family of meshes at an error that may lie between two of them or beyond the finest: the number of elements,
    and the wall time of mesher and solver."""

    def __init__(self, meshes, error):
        self.beyond = meshes[-1].error > error
        pairs = list(zip(meshes, meshes[1:]))
        coarse, fine = next((p for p in pairs if p[1].error <= error), pairs[-1])
        share = math.log(fine.error / error) / math.log(coarse.error / fine.error)
        share = max(share, -1.0)  # not below the coarsest mesh
        self.elements = fine.elements * (fine.elements / coarse.elements) ** share
        self.seconds = fine.loop_seconds * (fine.loop_seconds / coarse.loop_seconds) ** share

    @property
    def words(self):
        return count(self.elements, self.beyond) + ("" if self.beyond else f", {seconds_text(self.seconds)} s")


def count(number, about=False):
    """A number of elements for people: 1 234, or about 1.2e7."""
    if number >= 1e6:
        power = int(math.log10(number))
        return f"≈ {number / 10**power:.1f}·10<sup>{power}</sup>"
    if about:
        digits = max(0, int(math.log10(number)) - 1)
        return "≈ " + f"{round(number / 10**digits) * 10**digits:,.0f}".replace(",", " ")
    return f"{number:,.0f}".replace(",", " ")


def seconds_text(seconds):
    return f"{seconds:.0f}" if seconds >= 10 else f"{seconds:.1f}" if seconds >= 1 else f"{seconds:.2f}"


def verdict(right, sentence, wrong="WRONG: "):
    print(("ok: " if right else wrong) + sentence)
    return right


def check(study, section):
    """Whether all is as it must be."""
    name = section.name
    own = [m for m in study.meshes if m.section is section]
    low, high = max(m.low for m in own), min(m.high for m in own)
    right = [verdict(low - high <= ROUND_OFF * abs(high), f"{name}: the intervals of {len(own)} meshes meet: {low:.8g} to {high:.8g}")]
    if section.exact is not None:
        right.append(verdict(low <= section.exact * (1 + ROUND_OFF) and section.exact <= high * (1 + ROUND_OFF),
                             f"{name}: they contain the exact value {section.exact:.8g}"))
    for error in ERRORS:
        last = study.of(section, f"adapted to {error}")[-1]
        sentence = f"{name}: mesh.error = {error}: {100 * last.error:.3g} % with {last.elements} elements"
        expected = error < section.reaches
        right.append(verdict(last.error <= error, sentence, "not met, as expected: " if expected else "WRONG: ") or expected)
    fall = power([(mesh.elements, mesh.gap) for mesh in study.of(section, f"adapted to {ERRORS[-1]}")[1:]])
    if section.dimension == 2:
        right.append(verdict(fall is not None and fall <= LEAST_SLOPE, f"{name}: the gap falls with the power "
                             f"{'of one adapted mesh: none' if fall is None else f'{fall:.3g}'} of the elements"))
    last = study.of(section, f"adapted to {ERRORS[-1]}")[-1]
    uniform = Family(study.of(section, "uniform"), ERRORS[-1]).elements
    if last.error <= ERRORS[-1]:
        verdict(last.elements <= SHARE_OF_UNIFORM * uniform,
                f"{name}: {last.elements} elements, {last.elements / uniform:.2g} of the uniform ones", "more than a tenth: ")
    return all(right)


HEADER = ("section", "error", "meshes", "elements", "known to", "s of the loop", "s of the last solution", "uniform", "graded",
          "share of uniform", "slope")


def report(study, sections):
    rows = []
    for section in sections:
        for error in ERRORS:
            own = study.of(section, f"adapted to {error}")
            last = own[-1]
            met = last.error <= error
            # Where the loop stops before, the families are compared at the error that it reached.
            compared = error if met else last.error
            uniform, graded = (Family(study.of(section, kind), compared) for kind in ("uniform", "graded"))
            fall = power([(mesh.elements, mesh.gap) for mesh in own[1:]])
            title = section.words + (", 3D" if section.dimension == 3 else "") if error == ERRORS[0] else ""
            rows.append([title, f"{100 * error:g} %", len(own), count(last.elements), f"{100 * last.error:.2g} %{'' if met else ', **not met**'}",
                         seconds_text(last.loop_seconds), seconds_text(last.seconds), uniform.words, graded.words,
                         f"{last.elements / uniform.elements:.2g}", "" if fall is None or error == ERRORS[0] else f"{fall:.2f}".replace("-", "−")])
    sentences = [exact_sentence(study, section) for section in sections if section.exact is not None]
    return "\n".join([markdown(HEADER, rows), *sentences]) + "\n"


def exact_sentence(study, section):
    adapted = [study.of(section, f"adapted to {error}")[-1] for error in ERRORS]
    uniform = study.of(section, "uniform")[-1]

    def off(mesh):
        return f"{abs(mesh.middle / section.exact - 1.0):.1e}"

    largest = max(abs(m.middle - section.exact) / (0.5 * m.gap) for m in study.meshes if m.section is section)
    return (f"- {section.words[0].upper()}{section.words[1:]}: the middle of the interval is off by {' and '.join(map(off, adapted))} on the last adapted "
            f"meshes, by {off(uniform)} on the finest uniform mesh of {count(uniform.elements)} elements, and on no mesh by more than "
            f"{100 * largest:.0f} % of half of the interval.")


CURVES = {"adapted to 0.001": ("adapted", ("#0062bd", "none", "circle")), "graded": ("graded by hand", ("#009150", "2 4", "diamond")),
          "uniform": ("uniform", ("#000000", "8 5", "square"))}


def chart(rows, sections):
    """Error against elements of adapted, graded and uniform meshes, one chart for each section."""
    points = {}
    for row in rows:
        points.setdefault((row["section"], row["kind"]), []).append((float(row["elements"]), float(row["error"])))
    shown = [point for section in sections for kind in CURVES for point in points[section, kind]]
    x, y = (svg.decades([point[k] for point in shown]) for k in (0, 1))
    parts = []
    for number, section in enumerate(sections):
        panel = svg.Panel(x, y, "elements (-)", "" if number else "half of the interval over its middle (-)", title=section,
                          box=(82 + number * 338, 42, 290, 300), logarithmic=True)
        parts += panel.axes()
        for kind, (_, style) in CURVES.items():
            parts += panel.curve(points[section, kind], style)
    parts += panel.legend(CURVES.values())
    return svg.document(f"Error of the discharge against the number of elements: {', '.join(sections)}", parts, panel, 238)


def document(programs, out, docs):
    programs, out, docs = Path(programs), Path(out), Path(docs)
    sections = ("sheet-pile", "pile-over-clay", "disc")
    (docs / "images/adapted-error.svg").write_text(chart(read_rows(out / "meshes.csv"), sections), encoding="utf-8")
    run = out / "pile-over-clay/adapted-0.01/pile-over-clay"
    call(programs / "suffuse-solver", f"{run}.case.h5", "-o", f"{run}.results", "--force", "--quiet")
    call(programs / "suffuse-post", "render", f"{run}.results", "--field", "error", "--log", "-o", docs / "images/adapted-mesh.png")
    put_between("adapted", docs / "evidence/accuracy.md", "\n" + (out / "table.md").read_text(encoding="utf-8") + "\n")


def main():
    if len(sys.argv) < 3:
        sys.exit("usage: study.py PROGRAMS OUT [SECTION]...")
    if sys.argv[1] == "--document":
        return document(*sys.argv[2:])
    study = Study(sys.argv[1], sys.argv[2])
    sections = [s for s in SECTIONS if len(sys.argv) == 3 or s.name in sys.argv[3:]]
    for section in sections:
        for error in ERRORS:
            study.adapt(section, error)
        study.halve(section, "uniform", 1.0)
        study.halve(section, "graded", GRADING)
        study.write_meshes()
    (study.out / "table.md").write_text(report(study, sections), encoding="utf-8")
    sys.exit(0 if all([check(study, section) for section in sections]) else 3)


if __name__ == "__main__":
    main()

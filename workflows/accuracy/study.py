#!/usr/bin/python3
"""What an error costs: wall time and error of every run of a problem, and what the runs reached.

    study.py reference PROBLEM               prints the known values of a problem, as `suffuse-post error` takes them
    study.py measure BIN PROBLEM OUT [short] writes OUT/PROBLEM.csv, a line per run, and OUT/PROBLEM.left-out.csv, a line
                                             per run that --explain says would take too long; both without a header
    study.py check OUT                       verdicts on OUT/accuracy.csv; exit code 1 if one is wrong
    study.py document OUT DOCS               the results in DOCS/evidence/accuracy.md, the charts in DOCS/images
    study.py dam BIN OUT                     solves the dam on a mesh adapted to its flow, and prints its known values
"""

import collections
import math
import pathlib
import shutil
import sys

import numpy

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(1, str(here.parent))
from common import call, empty_folder, estimate_of, markdown, median, put_between, read_rows, run_json, set_options

# --- Known values ------------------------------------------------------------------------------------------

FLUX, EXPANSION = 0.012, 2.943e-4  # a head of 5886 Pa over a bulk modulus of 2e7 Pa
CAP, START, LENGTH = 0.4, 2.0, 1.0
CELLS, STEP = 100, 0.01


def phi(law, rate, n):
    """Eroded volume per volume and time at porosity n."""
    of_law = {"constant": rate, "logarithmic": -rate * numpy.log(n / CAP), "first-order": rate * (CAP - n)}
    return numpy.where(n >= CAP, 0.0, of_law[law])


def grown(law, rate, n, h):
    """One step of Runge and Kutta's for a porosity that is the same everywhere."""
    a = phi(law, rate, n)
    b = phi(law, rate, n + h * a / 2)
    c = phi(law, rate, n + h * b / 2)
    d = phi(law, rate, n + h * c)
    return min(n + h / 6 * (a + 2 * b + 2 * c + d), CAP)


def profile(law, rate, times, n0=0.3, slope=0.0, expansion=EXPANSION, count=50, across=("0.31", "0.77")):
    """Concentration of fluidised grains in a column that clean water enters, along the paths of the liquid:

        D c/Dt = (1 - c)(phi_e/n_L - c v p_drop/(K L)),  v = q/n_L,

    with a flux q whose mean is given and that grows along the column as water expands on its way to lower pressures
    (`expansion`: drop of the pressure over K). Parcels of liquid are followed by the midpoint rule. Nothing of the solver is
    in it. `slope`: gradient of the porosity along the flow, with the constant law alone. Rows t, x, y, concentration.
    """
    # When erosion starts: clean parcels, the first one at the outlet, the last one at the inlet.
    place, c = LENGTH * (1 - numpy.arange(401) / 400), numpy.zeros(401)
    concentration = lambda x: numpy.interp(x, place[::-1], c[::-1])
    t, n, rows = START, n0, []
    for moment in times:
        steps = int((moment - t) / STEP + 1 - 1e-9)
        h = (moment - t) / max(steps, 1)
        for step in range(steps):
            if step % 5 == 0:  # what expanded upstream
                water = 1 - concentration(numpy.arange(CELLS + 1) * LENGTH / CELLS)
                gain = numpy.concatenate([[0.0], numpy.cumsum(expansion / CELLS * (water[:-1] + water[1:]) / 2)])
                mean_gain = numpy.sum((gain[:-1] + gain[1:]) / 2 / CELLS)

            def rates(x, c, n):
                """Velocity and growth of the concentration of parcels; n is the porosity at the inlet."""
                i = numpy.minimum((x / LENGTH * CELLS).astype(int), CELLS - 1)
                q = FLUX * (1 + gain[i] + (gain[i + 1] - gain[i]) * (x / LENGTH * CELLS - i) - mean_gain)
                local = n + slope * x
                return q / local, (1 - c) * (phi(law, rate, local) - c * q * expansion / LENGTH) / local

            n_half = grown(law, rate, n, h / 2)
            speed, growth = rates(place, c, n)
            speed, growth = rates(place + h / 2 * speed, c + h / 2 * growth, n_half)
            place, c = place + h * speed, c + h * growth
            outside = max(int(numpy.sum(place > LENGTH)) - 1, 0)
            place, c = numpy.append(place[outside:], 0.0), numpy.append(c[outside:], 0.0)
            n = grown(law, rate, n_half, h / 2)
        t = moment
        x = (numpy.arange(count) + 0.5) * LENGTH / count
        rows += [(moment, line, LENGTH - place, value) for line in across for place, value in zip(x, concentration(x))]
    return rows


def kozeny_carman(n):
    return n**3 / (1 - n) ** 2


def reference(problem):
    """The lines of the known values. The numbers are those of PROBLEM.toml."""
    profiles = {"fines-constant": ("constant", 5e-3), "fines-log": ("logarithmic", 1e-2),
                "porosity-gradient": ("constant", 1e-3, (6, 12), 0.25, 0.1)}
    if problem in profiles:
        law, rate, *rest = profiles[problem]
        rows = profile(law, rate, *rest or [(6, 12)])
        return ["t,x,y,concentration", *(f"{t},{x},{y:.12g},{c:.12g}" for t, x, y, c in rows)]
    if problem == "startup":  # mean flux, (n P/(rho L)) tau (1 - exp(-t/tau)), downwards, tau = k/(n g), for any bulk modulus
        tau = 2e-2 / (0.3 * 9.81)
        values = [(0.005 * k, -0.3 * 6 * tau * (1 - math.exp(-0.005 * k / tau))) for k in range(1, 9)]
    elif problem == "feedback":  # under a constant head the mean flux is proportional to n^3/(1 - n)^2
        values = [(t, -0.0012 * kozeny_carman(0.3 + 5e-3 * (t - 2)) / kozeny_carman(0.3)) for t in range(2, 21, 2)]
    else:  # the dam: a run on a finer mesh than those of all compared runs
        return (here / f"{problem}.csv").read_text(encoding="utf-8").splitlines()
    return ["t,mean_darcy_flux_y", *(f"{t:g},{q:.15g}" for t, q in values)]


def dam(programs, out):
    """The lines of dam.csv. Takes some minutes."""
    stem = out / "dam-reference"
    out.mkdir(parents=True, exist_ok=True)
    keys = ["mesh.structure=free", "mesh.error=3e-5", "mesh.max_elements=600000", "time.tolerance=1e-4"]
    call(here.parent / "adapt.py", programs, here / "dam.toml", stem, *set_options(keys))
    call(programs / "suffuse-solver", f"{stem}.case.h5", "-o", f"{stem}.results", "--force", "--quiet")
    lines = ["t,x,y,concentration"]
    for t in (5, 10):
        for y in (0.25, 0.5, 0.75):
            table = f"{stem}.line.csv"
            call(programs / "suffuse-post", "sample", f"{stem}.results", "--time", t, "--line", f"0.03,{y}:2.97,{y}",
                 "--count", 40, "--fields", "concentration", "--csv", table)
            for row in read_rows(table):
                x, y_there, value = list(row.values())[1:4]
                lines.append(f"{t},{float(x):.12g},{float(y_there):.12g},{float(value):.6g}")
    return lines


# --- The runs of a problem ---------------------------------------------------------------------------------

# A scheme is FORMULATION-WAY: sp, dp in its default mode, or dp in the paper's mode (paper).
FORMULATIONS = {"sp": "formulation=single-point", "dp": "formulation=double-point", "paper": "formulation=double-point"}
WAYS = {"scaled": "time.scheme=explicit time.mass_scaling=1e4", "explicit": "time.scheme=explicit",
        "drag": "time.scheme=explicit time.drag=implicit", "implicit": "time.scheme=implicit"}
# As in Figs. 5 and 6 of the paper: see ../paper/variants.mk. Only the explicit scheme can have its pressure at points.
AS_IN_PAPER = ("points.seeding=gauss points.equal_volume=false soil.specimen.erosion.mass_transfer=element "
               "soil.specimen.erosion.empty_elements=dry")
AT_POINTS = "flow.integration=material-point"
OF_FINES = ["0.5", "0.25", "0.125", "0.0625", "0.03125", "0.015625"]
SIZES = {"fines-constant": OF_FINES, "fines-log": OF_FINES, "porosity-gradient": OF_FINES, "startup": OF_FINES[:3],
         "feedback": OF_FINES[:3], "dam": ["0.8", "0.4", "0.2", "0.1", "0.05"]}
SHORT_SIZES = {"fines-constant": OF_FINES[1:4], "dam": ["0.8", "0.4"]}
TOLERANCES = ["1e-3", "1e-2", "1e-4"]
# Points per element, the usual number first: solid points for sp, liquid points at the start otherwise.
POINTS = {"sp": ["3"], "dp": ["12", "3", "48"], "paper": ["12", "3"]}
FEW_POINTS = {"sp": ["3"], "dp": ["3"], "paper": ["3"]}


def sizes_of(problem, short, formulation, way, usual_points, tolerance):
    """Sizes of a series, the coarsest first.

    Only sp has the finest size of fines. Other numbers of points leave out the two finest sizes, or the finest with the implicit scheme,
    because they are slow and show nothing more. So do other tolerances.
    """
    if short:  # the check judges times of fines-constant, so it has runs long enough to be timed
        judged = problem == "fines-constant" and formulation == "sp"
        return OF_FINES[3:5] if judged else SHORT_SIZES.get(problem, OF_FINES[:2])
    if problem == "startup" and way != "implicit":
        return OF_FINES  # the error of the explicit schemes falls with the step, and the step with the size
    usual = usual_points and tolerance in ("", TOLERANCES[0])
    if SIZES[problem] is not OF_FINES:
        return SIZES[problem][: 4 if problem == "dam" and not usual else None]
    if formulation == "sp" and (usual or tolerance == "1e-2"):  # the tolerance to choose for these problems
        return OF_FINES
    return OF_FINES[: 5 if usual or way == "implicit" and not usual_points else 4]


def variants(problem, short):
    """The runs of a problem, coarse to fine within a series: scheme, size, points, tolerance ("" if there is none), keys."""
    points = POINTS
    if short or problem == "startup":
        points = FEW_POINTS
    elif problem in ("feedback", "dam"):  # the result does not depend on the places of the liquid points
        points = POINTS | {"dp": ["12", "3"]}
    for formulation, way in ((formulation, way) for formulation in FORMULATIONS for way in WAYS):
        usual, *others = points[formulation]
        # The stepping of drag does not depend on the points. Other tolerances are run only with the usual points.
        series = [(usual, "")] + [(count, "") for count in others if way != "drag"]
        if way == "implicit":
            series = [(usual, tolerance) for tolerance in TOLERANCES[: 1 if short else None]] + [(count, TOLERANCES[0]) for count in others]
        for count, tolerance in series:
            keys = [FORMULATIONS[formulation], WAYS[way]]
            keys += [f"points.liquid_per_element={count}"] * (formulation != "sp")
            keys += [AS_IN_PAPER] * (formulation == "paper") + [AT_POINTS] * (formulation == "paper" and way != "implicit")
            keys += [f"time.tolerance={tolerance}"] * bool(tolerance)
            # A problem in which nothing erodes has no exchange of mass.
            keys = [key for key in " ".join(keys).split() if problem != "startup" or "erosion" not in key]
            for size in sizes_of(problem, short, formulation, way, count == usual, tolerance):
                yield f"{formulation}-{way}", size, count, tolerance, [f"mesh.size={size}", *keys]


def measure(programs, problem, out, short):
    """Runs are timed, so they are made one after the other."""
    limit, repetitions, once = (1, 1, 0) if short else (6, 5, 0)  # s of the longest run; how often for the median; s of runs made once
    if short and problem == "fines-constant":
        limit, repetitions, once = 10, 3, 0.5
    growth = 16  # a run of the next size takes 8 times as long, or a little more
    work = empty_folder(out / f"{problem}.work")
    case, results = work / "run.case.h5", work / "run.results"
    lines, left_out, last = [], [], {}
    for scheme, size, count, tolerance, keys in variants(problem, short):
        series, row = (scheme, count, tolerance), [problem, scheme, size, count, tolerance]
        call(programs / "suffuse-mesher", here / f"{problem}.toml", "-o", case, *set_options(keys))
        if last.get(series, limit) > limit / growth:  # nothing is known yet of the first run in a series
            steps, expected, *_ = estimate_of(call(programs / "suffuse-solver", case, "--explain").stdout)
            if float(expected or "inf") > limit:  # no estimate if steps take too long to be tried
                left_out.append([*row, steps, expected])
                last[series] = limit
                continue
        seconds = []
        while len(seconds) < repetitions and not (short and seconds and float(seconds[-1]) > once):
            call(programs / "suffuse-solver", case, "-o", results, "--force", "--quiet")
            run = run_json(results)
            seconds.append(run["wall_seconds"])
        last[series] = float(median(seconds))
        call(programs / "suffuse-post", "error", results, "--reference", out / f"{problem}.reference.csv", "--csv", work / "error.csv")
        quantity, _, *errors = list(read_rows(work / "error.csv")[0].values())[:5]
        points = int(run["solid_points"]) + int(run["liquid_points"])
        lines.append([*row, quantity, *errors, median(seconds), run["steps"], run["elements"], points, run["memory_bytes"], run["threads"]])
    for suffix, rows in ((".left-out.csv", left_out), (".csv", lines)):
        (out / f"{problem}{suffix}").write_text("".join(",".join(map(str, row)) + "\n" for row in rows), encoding="utf-8")
    shutil.rmtree(work)


# --- What the runs reached ---------------------------------------------------------------------------------

WORDS = {"sp": "single-point", "dp": "double-point", "paper": "double-point, paper's mode"}
WORDS_OF_WAY = {"scaled": "explicit, mass scaling 1e4", "explicit": "explicit", "drag": "explicit, implicit drag", "implicit": "implicit"}
SCHEMES = [f"{formulation}-{way}" for formulation in FORMULATIONS for way in WAYS]


def words(scheme):
    formulation, way = scheme.split("-")
    return WORDS[formulation], WORDS_OF_WAY[way]


def seconds_text(s):
    return f"{s:.0f}" if s >= 100 else f"{s:.2g}" if s >= 0.01 else f"{s:.1g}"


def times_text(ratio):
    return f"{ratio:.0f} times" if ratio >= 10 else f"{ratio:.2g} times"


class Reached:
    """Runs, and runs left out, of each problem and scheme. A run is a pair of error and seconds."""

    def __init__(self, out, table):
        self.wrong, self.problems = [], []
        self.runs, self.left_out = collections.defaultdict(list), collections.defaultdict(list)
        for row in read_rows(table):
            if row["problem"] not in self.problems:
                self.problems.append(row["problem"])
            error, seconds = float(row["error_l1"]), float(row["seconds"])
            if 0.0 < error < math.inf and seconds > 0.0:
                self.runs[row["problem"], row["scheme"]].append((error, seconds))
            else:
                self.wrong.append(f"{row['problem']}, {row['scheme']}, size {row['size']}: error {row['error_l1']} in {row['seconds']} s")
        for row in read_rows(out / "left-out.csv"):
            self.left_out[row["problem"], row["scheme"]].append(row)

    def time_to(self, problem, scheme, most):
        """Fastest run with at most this error; None when there is none."""
        return min((seconds for error, seconds in self.runs[problem, scheme] if error <= most), default=None)

    def most_exact(self, problem, scheme):
        return min(self.runs[problem, scheme], key=lambda run: run[0], default=None)

    def shortest_left_out(self, problem, scheme):
        return min((float(row["seconds"] or 0) for row in self.left_out[problem, scheme]), default=None)

    def times_longer(self, problem, scheme):
        """How many times longer than the implicit scheme of its formulation, at the smallest error both reach."""
        default = ("sp" if scheme.startswith("sp") else "dp") + "-implicit"
        mine, other = self.most_exact(problem, scheme), self.most_exact(problem, default)
        if not mine or not other:
            return None
        both = max(mine[0], other[0])
        return self.time_to(problem, scheme, both) / self.time_to(problem, default, both)


def section(reached, problem):
    """The section of a problem in the document."""
    rows = []
    for scheme in SCHEMES:
        best = reached.most_exact(problem, scheme)
        if not best:
            continue
        cells = []
        for power in (-2, -3, -4):  # where the error is not reached, what the shortest run left out would take at least
            reach, left = reached.time_to(problem, scheme, 10.0**power * (1 + 1e-9)), reached.shortest_left_out(problem, scheme)
            cells.append(seconds_text(reach) if reach is not None else "-" if left is None else f"> {seconds_text(left)}")
        ratio = reached.times_longer(problem, scheme)
        rows.append([*words(scheme), *cells, f"{best[0]:.1e}", seconds_text(best[1]),
                     "" if ratio is None or scheme in ("sp-implicit", "dp-implicit") else times_text(ratio)])
    header = ["formulation", "scheme", "s to 1e-2", "s to 1e-3", "s to 1e-4", "best error", "in s", "longer than implicit"]
    parts = [f"### {problem}\n", f"![Wall time against error, {problem}](../images/accuracy-{problem}.png)\n", markdown(header, rows, (0, 1))]
    parts += saving(reached, problem) if problem.startswith("fines-") else []
    return "\n".join(parts + omitted(reached, problem)) + "\n"


def saving(reached, problem):
    """How much less the implicit scheme takes to an error of 1e-3 than the paper's without mass scaling: in the same
    formulation, and the quickest here beside the paper's double-point one."""
    found = []
    for explicit, implicit in (("sp-explicit", "sp-implicit"), ("paper-explicit", "dp-implicit"), ("paper-explicit", "sp-implicit")):
        slow, quick = (reached.time_to(problem, scheme, 1.000000001e-3) for scheme in (explicit, implicit))
        bound = "" if slow is not None else "more than "
        slow = reached.shortest_left_out(problem, explicit) if slow is None else slow
        if slow is not None and quick is not None:
            found.append(f"{', '.join(words(implicit))} takes {seconds_text(quick)} s to 1e-3, {', '.join(words(explicit))} {bound}"
                         f"{seconds_text(slow)} s, {bound}{times_text(slow / quick)} as long")
    text = "; ".join(found)
    return [text[0].upper() + text[1:] + ".\n"] if text else []


def omitted(reached, problem):
    found = []
    for scheme in SCHEMES:
        texts = [f"{row['size']} m" + (f" / {row['points_per_element']}" if not scheme.startswith("sp") else "")
                 + (f", tolerance {row['tolerance']}" if row["tolerance"] not in ("", "1e-3") else "") + f" {float(row['seconds'] or 0):g} s"
                 for row in reached.left_out[problem, scheme]]
        if texts:
            found.append(f"{', '.join(words(scheme))}: {', '.join(texts)}")
    text = "; ".join(found)
    by = "size / points per element" if "/" in text else "size"
    return [f"Left out, by {by}, with the seconds they would take: {text}.\n"] if text else []


def verdicts(reached):
    """Pairs: whether it is right, and the sentence."""
    for text in reached.wrong:
        yield False, text
    for problem in reached.problems:
        for scheme in SCHEMES:
            if not reached.runs[problem, scheme] and not reached.left_out[problem, scheme]:
                yield False, f"{problem}: no run of {scheme}"
    for scheme in ("sp-explicit", "paper-explicit"):
        ratio = reached.times_longer("fines-constant", scheme)
        if ratio is not None:
            yield ratio >= 10, f"fines-constant: {scheme} takes {ratio:.3g} times as long as the implicit scheme"
    for problem in reached.problems:  # mass scaling slows a flow from rest: no mesh helps
        for scheme in SCHEMES if problem in ("fines-log", "startup") else []:
            best = reached.most_exact(problem, scheme)
            if scheme.endswith("-scaled") and best:
                yield best[0] > 0.05, f"{problem}: {scheme} stays {best[0]:.2g} away, its flow has not settled"


def check(out, table="accuracy.csv"):
    found = list(verdicts(Reached(out, out / table)))
    for right, sentence in found:
        print(("ok: " if right else "WRONG: ") + sentence)
    return 0 if all(right for right, _ in found) else 1


def document(out, docs):
    for chart in out.glob("*.png"):
        shutil.copy(chart, docs / "images" / f"accuracy-{chart.name}")
    reached = Reached(out, out / "accuracy.csv")
    put_between("results", docs / "evidence/accuracy.md", "\n" + "".join(section(reached, problem) for problem in reached.problems))


def main(command, *arguments):
    paths = [pathlib.Path(argument) for argument in arguments]
    if command == "reference":
        print("\n".join(reference(arguments[0])))
    elif command == "measure":
        measure(paths[0].resolve(), arguments[1], paths[2].resolve(), "short" in arguments[3:])
    elif command == "check":
        return check(*paths)
    elif command == "document":
        document(*paths)
    elif command == "dam":
        print("\n".join(dam(*(path.resolve() for path in paths))))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

"""How safe a run is: what run.py wrote, as factors of safety. A factor below 1 is a failure.

A mechanism is a way to fail. Those of `suffuse-post check` have the words of its table; `slope` is the factor of safety
of the soil, by reduction of its strength.
"""

import dataclasses
import math
import os
import re

from common import cell, number_of, read, read_rows, run_json, wrong

# Mechanisms that depend on the water level, in the order of tables and charts. Other checks, such as those of filters,
# follow by their names.
MECHANISMS = ["erosion", "heave", "hyd-stresses", "hyd-forces", "uplift", "blanket", "backward-erosion", "slope"]
EROSION = "erosion"
SLOPE = "slope"
STATES = ["start", "last", "all", "checks"]
# What the programs say where soil cannot bear its loads; docs/use/troubleshooting.md has the messages.
SOIL_FAILS = re.compile(r"no equilibrium|lost its equilibrium|lose its equilibrium|soil that fails|the soil fails|"
                        r"(loaded surface|solid point \d+) moves .*far outside the mesh")
# The solver's warning of soil that may slide slowly.
CREEPS = re.compile(r"the soil has moved by .* in equilibrium")
NO_STRENGTH = "got no soil with a strength"


@dataclasses.dataclass
class Outcome:
    """Of one mechanism in one run. `factor` is None where the mechanism does not act, or where there is no number."""

    fails: bool
    factor: float = None
    place: str = ""
    clause: str = ""
    said: str = ""

    @property
    def utilisation(self):
        """Effect over resistance, which is linear in the head for most mechanisms; None where failure has no factor."""
        if self.factor is None:
            return None if self.fails else 0.0
        return math.inf if self.factor == 0.0 else 1.0 / self.factor


def in_order(mechanisms):
    known = {name: place for place, name in enumerate(MECHANISMS)}
    return sorted(mechanisms, key=lambda name: (known.get(name, len(known)), name))


def messages_of(stem):
    """What run.py could not find, and why: `check` or `factor` -> message. `warning` is no reason."""
    lines = read(stem.with_name(stem.name + ".assessed")).splitlines()
    found = {}
    for what, _, message in (line.partition(": ") for line in lines):
        message = re.sub(r"^suffuse-\w+: (error: )?", "", message)
        # Tables must not depend on where the scene lies.
        found[what] = "no soil has a strength" if NO_STRENGTH in message else message
    return found


def is_assessed(folder, name):
    """Whether the run has ended and has been looked at since."""
    stem = folder / name / name
    files = [stem.with_name(f"{name}.{suffix}") for suffix in ("assessed", "status")] + [folder / "assess.inputs"]
    if not all(file.is_file() for file in files):
        return False
    assessed, *before = (file.stat().st_mtime_ns for file in files)
    return assessed >= max(before)  # a run that failed at its start has both files within one tick of the clock


def slope_of(stem):
    """The least factor of the states that were asked for, or None; the message about those without one."""
    factors = [number_of(row.get("factor"), infinite=True) for row in read_rows(stem.with_name(stem.name + ".factors.csv"))]
    return min((factor for factor in factors if factor is not None), default=None), messages_of(stem).get("factor", "")


def places_of(stem):
    """The rows of the table of checks: pairs of mechanism and outcome."""
    found = []
    for row in read_rows(stem.with_name(stem.name + ".check.csv")):
        factor = number_of(row.get("factor"), infinite=True)
        found.append((row["mechanism"], Outcome(factor is not None and factor < 1.0, factor, row.get("where", ""), row.get("clause", ""))))
    return found


def checks_of(stem):
    """The worst place of each mechanism of the table of checks."""
    worst = {}
    for mechanism, outcome in places_of(stem):
        known = worst.get(mechanism)
        if known is None or known.factor is None or outcome.factor is not None and outcome.factor < known.factor:
            worst[mechanism] = outcome
    return worst


def history_of(stem):
    """The rows of history.csv of a run; none before it has any."""
    return read_rows(stem.with_name(f"{stem.name}.results") / "history.csv")


def most_of(rows, column):
    """The largest number of a column; 0 where there is none."""
    return max((number_of(row.get(column)) or 0.0 for row in rows), default=0.0)


def followed_failure(stem):
    """What is said of a run whose soil failed and was followed with its inertia, which may end well; nothing of other runs."""
    rows = history_of(stem)
    times = [time for row in rows if (time := number_of(row.get("failure_time")))]
    # Soil that fails at t = 0 has no time of failure.
    if not times and most_of(rows, "inertia") == 0.0:
        return ""
    when = f"lost its equilibrium at t = {times[0]:g} s" if times else "had no equilibrium at t = 0 s"
    return f"the soil {when}, and moved by up to {most_of(rows, 'displacement_max'):.3g} m"


def creep_of(stem):
    """By how much the soil of a run moved, m, where the solver warns that this is much for soil in equilibrium; 0 where it does not."""
    results = stem.with_name(f"{stem.name}.results")
    creeps = (results / "run.json").is_file() and any(CREEPS.match(text) for text in run_json(results).get("warnings", []))
    return most_of(history_of(stem), "displacement_max") if creeps and not followed_failure(stem) else 0.0


def said_of_creep(amount):
    """`amount`: by how much, and where."""
    return f"the soil moved by {amount}, in equilibrium: it may slide slowly, and the moment of failure depends on the mesh"


def column_of(mechanism):
    return "factor_" + mechanism.replace("-", "_")


def columns_of(folder, name):
    """The columns that a row of sweep.csv gets."""
    if not is_assessed(folder, name):
        return {"factor": "", "factor_message": "not looked at yet"}
    stem = folder / name / name
    factor, message = slope_of(stem)
    checks = checks_of(stem)
    columns = {"factor": cell(factor), "factor_message": message}
    columns |= {column_of(mechanism): cell(checks[mechanism].factor) for mechanism in in_order(checks)}
    return columns | {"check_message": messages_of(stem).get("check", "")}


def outcomes_of(folder, name, word, message, factor_of):
    """What each mechanism that depends on the level did in a run, and whether that is known of all of them. `factor_of`: of
    which states the factor is.

    A run that failed says nothing of the time after: its mechanisms are known if they had begun, or if the start alone was
    asked for. The loss of equilibrium is a failure of the slope, unless the start alone was asked for, and has a factor; also that of a
    run that follows the soil until it rests again.
    """
    if word not in ("done", "failed") or not is_assessed(folder, name):
        return {}, False
    stem = folder / name / name
    is_complete = (word == "done" or factor_of == "start") and stem.with_name(f"{name}.check.csv").is_file()
    outcomes = {mechanism: found for mechanism, found in checks_of(stem).items()
                if mechanism in MECHANISMS and (is_complete or found.fails)}
    factor, said = slope_of(stem)
    lost = [text for text in ([said] if factor is None or factor_of == "all" else []) + [message] * (word == "failed")
            if SOIL_FAILS.search(text)]
    lost += filter(None, [followed_failure(stem)])
    if factor is not None and (factor_of == "start" or not lost):
        moved = creep_of(stem) if factor >= 1.0 else 0.0
        texts = [said, said_of_creep(f"{moved:.3g} m") if moved else ""]
        outcomes[SLOPE] = Outcome(factor < 1.0, factor, said="; ".join(filter(None, texts)))
    elif lost:
        outcomes[SLOPE] = Outcome(True, factor if factor is not None and factor < 1.0 else None, said=lost[0])
    return outcomes, is_complete


def with_absent(runs):
    """`runs`: key -> what outcomes_of returned. The table of checks has no row of a mechanism that does not act; a run
    without a row gets such an outcome for each mechanism that others have."""
    absent = {mechanism: Outcome(False) for found, _ in runs.values() for mechanism in found if mechanism != SLOPE}
    return {key: absent | found if is_complete else found for key, (found, is_complete) in runs.items()}


WORDS = {"hyd-stresses": "heave by EN 1997-1, stresses", "hyd-forces": "heave by EN 1997-1, forces"}


def spoken(mechanism):
    return WORDS.get(mechanism, mechanism.replace("-", " "))


def said_of_others(stems):
    """What runs say of the checks that do not depend on the level, as the end of a sentence; nothing if there are none."""
    factors = {}
    for stem in stems:
        for mechanism, outcome in places_of(stem):
            if mechanism not in MECHANISMS and outcome.factor is not None:
                factors.setdefault((mechanism, outcome.place), []).append(outcome.factor)
    said = []
    for (mechanism, place), found in sorted(factors.items()):
        exceeded = sum(factor < 1.0 for factor in found)
        if exceeded:
            least, most = f"{min(found):.3g}", f"{max(found):.3g}"
            runs = "" if exceeded == len(found) else f" in {exceeded} of {len(found)} runs"
            said.append(f"{spoken(mechanism)} {place} has a factor of {least if least == most else f'{least} to {most}'} and is exceeded{runs}")
    failing = {mechanism for (mechanism, _), found in factors.items() if min(found) < 1.0}
    holding = sorted({spoken(mechanism) for mechanism, _ in factors if mechanism not in failing})
    if holding:
        said.append(f"{' and '.join(holding)} {'holds' if len(holding) == 1 else 'hold'}")
    return "; ".join(said)


# --- Soil that fails by itself ---------------------------------------------------------------------------------

# Their soil has no strength that could be reduced.
WITHOUT_STRENGTH = ("rigid", "elastic")
NAME = re.compile(r"[\w.-]+")


def table_in(value, key):
    """A table of a scene; an empty one where there is none, which the mesher refuses."""
    found = value.get(key) if isinstance(value, dict) else None
    return found if isinstance(found, dict) else {}


def may_have_strength(soils, name, keys):
    """Whether a soil has a strength, or gets one by a key that the runs change."""
    known = set()
    while isinstance(name, str) and name not in known:
        if any(key == f"soil.{name}" or key.startswith((f"soil.{name}.skeleton", f"soil.{name}.like")) for key in keys):
            return True
        law = table_in(table_in(soils, name), "skeleton").get("law")
        if law is not None:
            return law not in WITHOUT_STRENGTH
        known.add(name)
        name = table_in(soils, name).get("like")
    return False


def reduction_options(scene, keys, states):
    """Options of the strength reduction, from REGION, DEEPER and QUADRATIC. `keys`: those of the scene that runs change. `states`: of
    which states the factor is; "" for none. Throws InputError."""
    names = sorted(set(os.environ.get("REGION", "").split()))
    depth, quadratic = (os.environ.get(variable, "").strip() for variable in ("DEEPER", "QUADRATIC"))
    for variable, text in (("REGION", " ".join(names)), ("DEEPER", depth), ("QUADRATIC", quadratic)):
        if text and states in ("", "checks"):
            wanted = "FACTOR=1, all or start" if not states else "FACTOR=start, last or all"
            raise wrong(variable, "", f"'{text}' {'with FACTOR=checks' if states else 'without FACTOR'}", f"{wanted} beside it")
    soils = table_in(scene, "soil")
    changed = {key.split(".")[1] for key in keys if key.startswith("soil.") and key.count(".")}
    strong = [name for name in sorted({*soils, *changed}) if NAME.fullmatch(name) and may_have_strength(soils, name, keys)]
    options = []
    for name in names:
        if name not in strong:
            known = " or ".join(strong) or "a scene with such a soil; this one has none"
            raise wrong("REGION", "", f"'{name}'", f"soils with a strength, with spaces between several: {known}", strong)
        options += ["--region", name]
    if depth:
        value = number_of(depth)
        if value is None or value <= 0.0:
            raise wrong("DEEPER", "", f"'{depth}'", "a depth above 0, m")
        if "gravity" not in keys and not any(scene.get("gravity", [0.0])):
            raise wrong("DEEPER", "", f"'{depth}'", "a scene with gravity; this one has none")
        options += ["--deeper", f"{value:.10g}"]
    if quadratic not in ("", "0", "1"):
        raise wrong("QUADRATIC", "", f"'{quadratic}'", "1 for quadratic displacements, or 0")
    return options + (["--quadratic"] if quadratic == "1" else [])


def said_of_options(options):
    """What the options leave out, and how they find the rest, as a sentence; nothing without options."""
    given = list(zip(options, options[1:] + [""]))
    names = [value for option, value in given if option == "--region"]
    said = [f"only {' and '.join(names)} can fail, other soil is elastic"] if names else []
    said += [f"bodies within {value} m of the surface are left out" for option, value in given if option == "--deeper"]
    said += ["displacements are quadratic" for option in options if option == "--quadratic"]
    return ", and ".join(said)

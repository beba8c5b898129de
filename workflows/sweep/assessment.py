"""How safe a run is: what assess.sh wrote, as factors of safety. A factor below 1 is a failure.

A mechanism is a way to fail. Those of `suffuse-post check` have the words of its table; `slope` is the factor of safety
of the soil, by reduction of its strength.
"""

import csv
import dataclasses
import math
import re

# The order in tables and charts. Mechanisms that are not in this list follow by their names.
MECHANISMS = ["erosion", "heave", "hyd-stresses", "hyd-forces", "uplift", "backward-erosion", "filter", "slope"]
SLOPE = "slope"
STATES = ["start", "last", "all", "checks"]
# What the programs say where soil cannot bear its loads; docs/troubleshooting.md has the messages.
SOIL_FAILS = re.compile(r"no equilibrium|lost its equilibrium|lose its equilibrium|soil that fails|the soil fails")
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


def number(text):
    try:
        value = float(text)
    except (TypeError, ValueError):
        return None
    return None if math.isnan(value) else value


def rows_of(path):
    """Rows of a table; names of columns without their units."""
    if not path.is_file():
        return []
    with open(path, encoding="utf-8", newline="") as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    names = [re.sub(r"\s*[\[(].*", "", name).strip() for name in rows[0]] if rows else []
    return [dict(zip(names, row)) for row in rows[1:]]


def messages_of(stem):
    """What assess.sh could not find, and why: `check` or `factor` -> message."""
    lines = stem.with_name(stem.name + ".assessed").read_text(encoding="utf-8", errors="replace").splitlines()
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
    return assessed > max(before)


def slope_of(stem):
    """The least factor of the states that were asked for, or None; the message about those without one."""
    factors = [number(row.get("factor")) for row in rows_of(stem.with_name(stem.name + ".factors.csv"))]
    return min((factor for factor in factors if factor is not None), default=None), messages_of(stem).get("factor", "")


def checks_of(stem):
    """The worst place of each mechanism of the table of checks."""
    worst = {}
    for row in rows_of(stem.with_name(stem.name + ".check.csv")):
        factor = number(row.get("factor"))
        outcome = Outcome(factor is not None and factor < 1.0, factor, row.get("where", ""), row.get("clause", ""))
        known = worst.get(row["mechanism"])
        if known is None or known.factor is None or factor is not None and factor < known.factor:
            worst[row["mechanism"]] = outcome
    return worst


def column_of(mechanism):
    return "factor_" + mechanism.replace("-", "_")


def cell(value):
    return "" if value is None else f"{value:.10g}"


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
    """What each mechanism did in a run, and whether that is known of all that are checked. `factor_of`: of which states
    the factor is.

    A run that failed says nothing of the time after: its mechanisms are known if they had begun, or if the start alone was
    asked for. The loss of equilibrium is a failure of the slope, unless the start alone was asked for, and has a factor.
    """
    if word not in ("done", "failed") or not is_assessed(folder, name):
        return {}, False
    stem = folder / name / name
    is_complete = (word == "done" or factor_of == "start") and stem.with_name(f"{name}.check.csv").is_file()
    outcomes = {mechanism: found for mechanism, found in checks_of(stem).items() if is_complete or found.fails}
    factor, said = slope_of(stem)
    lost = [text for text in ([said] if factor is None or factor_of == "all" else []) + [message] * (word == "failed")
            if SOIL_FAILS.search(text)]
    if factor is not None and (factor_of == "start" or not lost):
        outcomes[SLOPE] = Outcome(factor < 1.0, factor, said=said)
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

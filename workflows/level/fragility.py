#!/usr/bin/python3
"""How probable is failure at a level? `make -C workflows fragility` calls this.

Writes table.csv, the sweep's table: every draw at every level, fragility.csv, draws.csv, report.md and fragility.svg. LEVELS, SWEEP,
BOUNDARY, STEADY, SET, FACTOR, REGION, DEEPER and QUADRATIC come from the environment. Exit codes: 2 for wrong input; 1 if runs
have no answer.
"""

import os

from scipy.stats import beta

from levels import (InputError, call, creep_of_runs, csv_text, named_failures, outcomes, report, rounded, rows_of_sweep, said_beside,
                    write_changed, write_table, wrong)
from assessment import EROSION, SLOPE, Outcome, in_order, said_of_creep, spoken
from common import cell, number_of
from runs import MOST_RUNS, read_runs
from svg import CURVES, Panel, document

ANY = "any of them"
# Erosion beyond a threshold is no breach.
ANY_BUT = "any but erosion"
# Between the intervals of mechanisms at one level, pixels; and how far from the level they may be, as a share of the axis.
APART = 7
ASIDE = 0.01
# Levels that the axis can name.
MOST_MARKED = 8


SHARE = 0.95  # how often the bounds of a probability hold


def bounds(failures, runs):
    """The interval of probabilities with which so many failures are not unlikely: that of Clopper and Pearson (1934, Biometrika 26,
    404), which is never too narrow. Its digits do not depend on the version of SciPy."""
    tail = 0.5 * (1.0 - SHARE)
    low = 0.0 if failures == 0 else beta.ppf(tail, failures, runs - failures + 1)
    high = 1.0 if failures == runs else beta.ppf(1.0 - tail, failures + 1, runs - failures)
    return float(f"{low:.6g}"), float(f"{high:.6g}")


def asked_levels():
    text = os.environ.get("LEVELS", "").strip()
    numbers = [number_of(part) for part in text.split(",")]
    levels = [rounded(number) for number in numbers if number is not None]
    if len(levels) < len(numbers) or levels != sorted(set(levels)):
        raise wrong("LEVELS", "", f"'{text}'" if text else "nothing", "rising numbers with commas between them, m")
    return levels


def draws_of(study):
    """Keys, and a list of their values for each draw."""
    path = os.environ["SWEEP"]
    keys, draws = read_runs(path)
    taken = [key for key in keys if key in study.keys or key in study.changes() or any(own.startswith(f"{key}.") for own in study.keys)]
    if taken:
        raise wrong(path, taken[0], "a key that this study sets", "other keys: the level is that of LEVELS, others are in SET")
    return keys, draws


def rows_of(study):
    """Pairs of draw and level for each run, and the table. The levels of a draw stand together, so that more draws keep the
    runs of those before."""
    levels = asked_levels()
    study.check_levels("LEVELS", levels)
    keys, draws = draws_of(study)
    if len(draws) * len(levels) > MOST_RUNS:
        raise wrong("LEVELS", "", f"{len(levels)} levels of {len(draws)} draws", f"at most {MOST_RUNS} runs")
    changes = study.changes()
    table = [[*study.keys, *changes, *keys]]
    table += [[*study.cells(level), *changes.values(), *draw] for draw in draws for level in levels]
    return [(number + 1, level) for number in range(len(draws)) for level in levels], table


def prepare(study, folder):
    write_table(study, folder, rows_of(study)[1])


def groups_of(mechanisms):
    """Names of groups of mechanisms, and what is in them."""
    others = [name for name in mechanisms if name != EROSION]
    groups = {ANY: mechanisms} if len(mechanisms) > 1 else {}
    return groups | ({ANY_BUT: others} if others and len(others) < len(mechanisms) else {})


def with_any(found, mechanisms):
    """Adds the failure of any mechanism of each group: known where one fails, or where none is missing."""
    groups = {}
    for name, members in groups_of(mechanisms).items():
        fails = any(found[member].fails for member in members if member in found)
        if fails or found.keys() >= set(members):
            groups[name] = Outcome(fails)
    return found | groups


def shares(runs, mechanisms, levels):
    """Rows of fragility.csv. `runs`: draw, level, outcomes."""
    for mechanism in mechanisms:
        for level in levels:
            found = [outcome for _, at, outcome in runs if at == level]
            failed = [outcome[mechanism].fails for outcome in found if mechanism in outcome]
            share = sum(failed) / len(failed) if failed else None
            low, high = bounds(sum(failed), len(failed)) if failed else (None, None)
            yield [mechanism, cell(level), len(failed), sum(failed), cell(share), cell(low), cell(high), len(found) - len(failed)]


HEADER = ["mechanism", "level [m]", "runs", "failures", "probability [-]", "low [-]", "high [-]", "no_answer"]


def draw_chart(path, table, mechanisms, levels):
    margin = 0.08 * ((levels[-1] - levels[0]) or 1.0)
    panel = Panel((levels[0] - margin, levels[-1] + margin), (-0.03, 1.03), "level (m)", "probability of failure (-)",
                  levels if len(levels) <= MOST_MARKED else None)
    parts = list(panel.axes())
    numbers = {mechanism: tuple(tuple(row[1:]) for row in table if row[0] == mechanism) for mechanism in mechanisms}
    # Mechanisms with the same numbers share a curve, as one would hide the other.
    styles = dict(zip(dict.fromkeys(numbers.values()), CURVES))
    apart = min(panel.length(APART), 2.0 * ASIDE * (panel.x[1] - panel.x[0]) / max(1, len(styles) - 1))
    for place, (rows, style) in enumerate(styles.items()):
        shift = apart * (place - (len(styles) - 1) / 2)
        points = [(float(row[0]) + shift, *map(float, row[3:6])) for row in rows if row[3] != ""]
        for x, _, low, high in points:
            parts += panel.bar(x, low, high, style)
        parts += panel.curve([point[:2] for point in points], style)
    parts += panel.legend([(spoken(mechanism), styles[rows]) for mechanism, rows in numbers.items()],
                          ["Mechanisms with the same numbers share a curve."] if len(styles) < len(numbers) else [])
    write_changed(path, document("Probability of failure of each mechanism against the level", parts, panel))


def conclude(study, folder):
    pairs, _ = rows_of(study)
    levels = asked_levels()
    rows = rows_of_sweep(folder)
    found = outcomes(study, folder, dict(enumerate(rows)))
    runs = [(draw, level, found[place]) for place, (draw, level) in enumerate(pairs) if place in found]
    silent = [row for row, (_, _, found) in zip(rows, runs) if not found]
    names = in_order({name for _, _, found in runs for name in found})
    # A mechanism that never acts and whose check has nothing to look at is not shown as safe.
    mechanisms = [name for name in names if any(name in found and (found[name].fails or found[name].factor is not None)
                                                for _, _, found in runs)]
    if not mechanisms:
        raise InputError(["no run says how safe it is", *named_failures(folder, silent)])
    runs = [(draw, level, with_any({name: found[name] for name in mechanisms if name in found}, mechanisms))
            for draw, level, found in runs]
    shown = [*mechanisms, *groups_of(mechanisms)]
    table = list(shares(runs, shown, levels))
    write_changed(folder / "fragility.csv", csv_text([HEADER, *table]))
    draws = [[draw, row["run"], cell(level), *(cell(found[name].factor) if name in found else "" for name in mechanisms),
              " ".join(name for name in mechanisms if name in found and found[name].fails)]
             for row, (draw, level, found) in zip(rows, runs)]
    write_changed(folder / "draws.csv", csv_text([["draw", "run", "level [m]", *(f"{name} [-]" for name in mechanisms), "fails"], *draws]))
    draw_chart(folder / "fragility.svg", table, shown, levels)
    lines = [f"Probability of failure in {len(runs) // len(levels)} draws, with bounds that hold {100 * SHARE:g} % of the time:"]
    lines += [f"- {spoken(name)} at {level} m: {probability} ({low} to {high})" + (f"; {missing} runs have no answer" if missing else "")
              for name, level, _, _, probability, low, high, missing in table if probability]
    absent = [spoken(name) for name in names if name not in mechanisms]
    if absent:
        lines.append(f"No run has a factor of {' or '.join(absent)}.")
    if SLOPE not in mechanisms:
        lines.append("The slope was not looked at.")
    moved = creep_of_runs(study, folder, dict(enumerate(rows)), found)
    if moved:
        lines.append(f"Warning: slope: {said_of_creep(f'up to {max(moved.values()):.3g} m in {len(moved)} of {len(rows)} runs')}.")
    lines += said_beside(study, folder, rows, mechanisms, "Not counted")
    return report(study, folder, lines, rows, silent)


if __name__ == "__main__":
    call("fragility", prepare, conclude)

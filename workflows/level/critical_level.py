#!/usr/bin/python3
"""At which level does each mechanism begin? `make -C workflows critical-level` calls this.

Writes table.csv, the sweep's table, levels.csv, critical.csv, report.md and levels.svg. `prepare` follows the search from its
start, as far as the runs so far answer it, and adds the levels that it needs next. So a study that was stopped goes on, and one
that is complete adds nothing. At the start of a steady level the slope is looked at apart, with the table slope.csv: runs with
elastic soil give the flow, and the factor, which takes most of the time, is found only in the first round and where the slope
begins. BOUNDARY, FROM, TO, SCAN, TOLERANCE_LEVEL, STEADY, SET, FACTOR, REGION, DEEPER and QUADRATIC come from the environment.
Exit codes: 2 for wrong input; 1 if runs have no answer.
"""

import dataclasses
import math

from levels import (InputError, call, creep_of_runs, csv_text, named_failures, number_in, outcomes, report, rounded, rows_of_sweep,
                    said_beside, slopes_of, stems_of, write_changed, write_table, wrong)
from assessment import SLOPE, in_order, is_assessed, messages_of, said_of_creep, spoken
from common import cell, read_rows
from svg import CURVES, Panel, document

SCAN = 5
TOLERANCE = 0.01  # of TO - FROM
# Half the distance of the two levels around an interpolated one, in tolerances: if both answer as expected, the search ends.
BESIDE = 0.45
# Every third round halves the brackets, as interpolation may approach a crossing from one side only.
HALVING = 3
HIGHEST_SHOWN = 4.0


@dataclasses.dataclass
class Search:
    """Between which levels a mechanism begins. `kind`: "between", "below", "above", "absent" or "unknown"."""

    kind: str
    holds: float = None
    fails: float = None


def asked():
    low, high = number_in("FROM"), number_in("TO")
    if not low < high:
        raise wrong("FROM", "", f"{low:g}, and TO={high:g}", "a level below TO")
    scan = number_in("SCAN", SCAN)
    if scan != int(scan) or not 2 <= scan <= 1000:
        raise wrong("SCAN", "", f"{scan:g}", "a whole number of levels from 2 to 1000")
    tolerance = number_in("TOLERANCE_LEVEL", TOLERANCE * (high - low))
    if not 1e-6 * (high - low) <= tolerance <= high - low:
        raise wrong("TOLERANCE_LEVEL", "", f"{tolerance:g}", f"a length from {1e-6 * (high - low):g} to {high - low:g} m")
    scan = int(scan)
    return [rounded(low + (high - low) * k / (scan - 1)) for k in range(scan)], tolerance


def search(mechanism, known, ends):
    """`known`: level -> outcomes of its run. `ends`: FROM and TO."""
    points = sorted((level, found[mechanism]) for level, found in known.items() if mechanism in found)
    if all(not outcome.fails and outcome.factor is None for _, outcome in points):
        return Search("absent" if points[-1][0] == ends[1] else "unknown", holds=points[-1][0])
    fails = next((level for level, outcome in points if outcome.fails), None)
    holds = max((level for level, outcome in points if fails is None or level < fails), default=None)
    if fails is None:
        return Search("above" if holds == ends[1] else "unknown", holds=holds)
    if holds is None:
        return Search("below" if fails == ends[0] else "unknown", fails=fails)
    return Search("between", holds, fails)


def crossing(mechanism, known, found):
    """Where effect over resistance reaches 1, by a straight line; the middle where soil fails without a factor."""
    low, high = (known[level][mechanism].utilisation for level in (found.holds, found.fails))
    if high is None or math.isinf(high) or not low < high:
        return 0.5 * (found.holds + found.fails)
    return found.holds + (found.fails - found.holds) * (1.0 - low) / (high - low)


def next_levels(mechanism, known, ends, tolerance, halve):
    """Levels that narrow the bracket of a mechanism; none if it is narrow, or if runs there have no answer."""
    found = search(mechanism, known, ends)
    if found.kind != "between" or found.fails - found.holds <= tolerance * (1.0 + 1e-9):
        return []
    at = crossing(mechanism, known, found)
    pair = [rounded(at - BESIDE * tolerance), rounded(at + BESIDE * tolerance)]
    middle = [rounded(0.5 * (found.holds + found.fails))]
    for levels in ([] if halve else [pair]) + [middle]:
        levels = [level for level in levels if found.holds < level < found.fails and level not in known]
        if levels:
            return levels
    return []


def replay(coarse, known, tolerance, slopes=None):
    """All levels of the search in the order in which they are wanted, as far as `known` answers it, and those of the slope. `slopes`:
    levels whose slope is known, if it is looked at apart: then it has its own levels and those of the first round."""
    levels, of_slope, ends, turn = list(coarse), list(coarse), (coarse[0], coarse[-1]), 1
    while all(level in known for level in levels) and (slopes is None or all(level in slopes for level in of_slope)):
        mechanisms = {mechanism for level in levels for mechanism in known[level]}
        wanted = {}
        for mechanism in mechanisms:
            at = of_slope if mechanism == SLOPE and slopes is not None else levels
            so_far = {level: known[level] for level in at}
            for level in next_levels(mechanism, so_far, ends, tolerance, turn % HALVING == 0):
                wanted.setdefault(level, set()).add(mechanism)
        if not wanted:
            break
        levels += sorted(wanted.keys() - set(levels))
        of_slope += sorted(level for level, by in wanted.items() if SLOPE in by)
        turn += 1
    return levels, of_slope


# --- Runs ----------------------------------------------------------------------------------------------------


def table_of(study, levels, changes):
    return [[*study.keys, *changes], *([*study.cells(level), *changes.values()] for level in levels)]


def run_changes(study):
    """The changes of the runs: their soil is elastic if the slope is looked at apart."""
    elastic = study.elastic_changes()
    return study.changes() if elastic is None else elastic


def known_of(study, folder):
    """Level -> row of the sweep, of the runs that have ended."""
    changes = run_changes(study)
    ended = [row for row in rows_of_sweep(folder) if row["status"] != "unfinished" and is_assessed(folder / "runs", row["run"])
             and changes.items() <= row.items()]
    known = {study.level_of(row): row for row in ended}
    return {level: row for level, row in known.items() if level is not None}


def prepare(study, folder):
    coarse, tolerance = asked()
    study.check_levels("FROM", coarse)
    slopes = slopes_of(study, folder)
    known = outcomes(study, folder, known_of(study, folder), slopes)
    levels, of_slope = replay(coarse, known, tolerance, slopes)
    write_table(study, folder, table_of(study, levels, run_changes(study)),
                None if slopes is None else table_of(study, of_slope, study.changes()))


# --- Tables and report ---------------------------------------------------------------------------------------


def metres(level):
    return f"{level:.4g} m"


def rank(outcome):
    """Sorts by the factor: soil that fails without one first, mechanisms that do not act last."""
    return (-math.inf if outcome.fails else math.inf) if outcome.factor is None else outcome.factor


def governing(found):
    """The mechanism with the least factor at a level, or nothing where none acts."""
    acting = [name for name in in_order(found) if found[name].fails or found[name].factor is not None]
    return min(acting, key=lambda name: rank(found[name]), default="")


def row_of(mechanism, known, found):
    """The row of critical.csv, and a sentence."""
    row = dict.fromkeys(["level", "holds_at", "fails_at", "where", "clause"], "")
    begun = known[found.fails][mechanism] if found.fails is not None else None
    if begun:
        row |= {"fails_at": cell(found.fails), "where": begun.place, "clause": begun.clause}
    if found.holds is not None:
        row["holds_at"] = cell(found.holds)
    factor_at = lambda level: f"its factor is {known[level][mechanism].factor:.3g} there"
    name = spoken(mechanism)
    if found.kind == "between":
        level = crossing(mechanism, known, found)
        row["level"] = cell(rounded(level))
        place = f", {begun.place}" if begun.place else ""
        said = f"{name} begins at {metres(level)}{place} (holds at {metres(found.holds)}, fails at {metres(found.fails)})"
        if begun.factor is None:
            said += f"; it fails without a factor: {begun.said}"
    elif found.kind == "below":
        said = f"{name} begins below FROM = {metres(found.fails)}: " + (factor_at(found.fails) if begun.factor is not None else begun.said)
    elif found.kind == "above":
        acts = known[found.holds][mechanism].factor is not None
        said = f"{name} begins above TO = {metres(found.holds)}: " + (factor_at(found.holds) if acts else "it does not act there")
    elif found.kind == "absent":
        said = f"{name}: no level has a factor"
    else:
        end = f"holds up to {metres(found.holds)}" if found.holds is not None else f"fails at {metres(found.fails)}"
        said = f"{name} {end}; runs {'above' if found.holds is not None else 'below'} have no answer"
    return {"mechanism": mechanism, **row, "found": found.kind, "said": said}


def first_to_begin(rows, known):
    """The row of the mechanism that governs, or None."""
    below = [row for row in rows if row["found"] == "below"]
    if below:
        return min(below, key=lambda row: rank(known[float(row["fails_at"])][row["mechanism"]]))
    return min((row for row in rows if row["level"]), key=lambda row: float(row["level"]), default=None)


def not_looked_at(folder, runs, mechanisms):
    """Why there is no slope, if there is none."""
    if SLOPE in mechanisms:
        return []
    said = [messages_of(stems_of(folder, row)[-1]).get("factor") for row in runs]
    return [f"slope was not looked at: {next((text for text in said if text), 'FACTOR=checks')}"]


def said_of_creeping(moved):
    """A warning of soil that moved at levels where its slope holds. `moved`: level -> by how much."""
    if not moved:
        return []
    places = {min(moved): None, max(moved, key=moved.get): None}
    return [f"- Warning: slope: {said_of_creep(' and '.join(f'{moved[level]:.3g} m at a level of {metres(level)}' for level in places))}."]


def levels_table(runs, known, mechanisms):
    header = ["level [m]", "run", "status", *(f"{name} [-]" for name in mechanisms), "governs", "message"]
    rows = []
    for level, row in sorted(runs.items()):
        found = known[level]
        factors = [cell(found[name].factor) if name in found else "" for name in mechanisms]
        message = row["message"] or (found[SLOPE].said if SLOPE in found else "")
        rows.append([cell(level), row["run"], row["status"], *factors, governing(found), message])
    return [header, *rows]


def curves_of(known, mechanisms):
    """Points of each mechanism that acts."""
    points = {name: [(level, found[name].factor) for level, found in sorted(known.items())
                     if name in found and found[name].factor is not None] for name in mechanisms}
    return {name: line for name, line in points.items() if line}


def words_of(name, line, begins):
    """The entry of a mechanism in the legend of the chart. `line`: its points."""
    if name in begins:
        return f"{spoken(name)}, from {metres(begins[name])}"
    return spoken(name) + (f", above {HIGHEST_SHOWN:g}" if min(factor for _, factor in line) > HIGHEST_SHOWN else "")


def draw(path, known, mechanisms, rows):
    curves = curves_of(known, mechanisms)
    shown = [min(factor, HIGHEST_SHOWN) for line in curves.values() for _, factor in line]
    panel = Panel((min(known), max(known)), (0.0, max(1.5, *shown, 1.5)), "level (m)", "factor of safety (-)")
    parts = [*panel.axes(), *panel.rule(1.0)]
    begins = {row["mechanism"]: float(row["level"]) for row in rows if row["level"]}
    for name, style in zip(curves, CURVES):
        parts += panel.curve(curves[name], style)
        if name in begins:
            parts += panel.drop(begins[name], 1.0, style)
    legend = [(words_of(name, curves[name], begins), style) for name, style in zip(curves, CURVES)]
    write_changed(path, document("Factor of safety of each mechanism against the level", [*parts, *panel.legend(legend)], panel))


def conclude(study, folder):
    levels, tolerance = asked()
    rows_known = known_of(study, folder)
    wanted = rows_of_sweep(folder)
    slopes = slopes_of(study, folder)
    for made in (wanted, list((slopes or {}).values())):
        if made and all(row["status"] == "refused" for row in made):
            raise InputError([f"no run can be made: {made[0]['message']}"])
    known = outcomes(study, folder, rows_known, slopes)
    for level, row in [(study.level_of(row), row) for row in wanted] + list(rows_known.items()):
        row["slope"] = (slopes or {}).get(level, {}).get("run")
    mechanisms = in_order({name for found in known.values() for name in found})
    silent = [row for row in wanted if not known.get(study.level_of(row))]
    for level in [study.level_of(row) for row in read_rows(folder / "slope.csv")]:
        end = slopes.get(level, {"status": "unfinished", "message": ""})
        silent += [end | {"run": f"slope at {metres(level)}"}] * (end["status"] in ("unfinished", "refused"))
    if not mechanisms:
        raise InputError(["no run says how safe it is", *named_failures(folder, silent)])
    rows = [row_of(name, known, search(name, known, (levels[0], levels[-1]))) for name in mechanisms]
    acting = [row["mechanism"] for row in rows if row["found"] != "absent"]
    write_changed(folder / "levels.csv", csv_text(levels_table(rows_known, known, acting)))
    names = {"level": "level [m]", "holds_at": "holds_at [m]", "fails_at": "fails_at [m]"}
    write_changed(folder / "critical.csv", csv_text([[names.get(name, name) for name in rows[0]], *(row.values() for row in rows)]))
    draw(folder / "levels.svg", known, mechanisms, rows)
    first = first_to_begin(rows, known)
    lines = [f"{first['said'][0].upper()}{first['said'][1:]}. It governs." if first else
             f"No mechanism is known to begin between {metres(levels[0])} and {metres(levels[-1])}."]
    lines += [f"- {row['said']}." for row in rows if row is not first and row["found"] != "absent"]
    absent = [spoken(row["mechanism"]) for row in rows if row["found"] == "absent"]
    lines += [f"- {' and '.join(absent)}: no level has a factor."] if absent else []
    lines += said_of_creeping(creep_of_runs(study, folder, rows_known, known))
    lines += [f"- {text}." for text in not_looked_at(folder, rows_known.values(), mechanisms)]
    lines += ["", *beside] if (beside := said_beside(study, folder, rows_known.values(), mechanisms, "Not part of the search")) else []
    return report(study, folder, lines, wanted, silent)


if __name__ == "__main__":
    call("critical-level", prepare, conclude)

#!/usr/bin/python3
"""Do the studies of levels find levels and probabilities that are known, without any run? Prints what fails."""

import json
import math
import os
import pathlib
import tempfile
from scipy.stats import binom

from expectations import answer, expect, expect_near, finish
from assessment import MECHANISMS as ON_LEVEL
from assessment import Outcome, checks_of, outcomes_of, reduction_options, said_of_options, said_of_others, with_absent
from critical_level import crossing, draw, replay, said_of_creeping, search
from fragility import bounds, draw_chart, groups_of, with_any
from levels import Study, creep_of_runs, named_warnings
from svg import CURVES, WIDTH

FROM, TO, SCAN, TOLERANCE = 1.0, 4.0, [1.0, 1.75, 2.5, 3.25, 4.0], 0.03


# Factors of mechanisms against the level, and the level where each is 1; None: there is no factor.
def of_factor(factor):
    return Outcome(factor is not None and factor < 1.0, factor)


MECHANISMS = {
    "heave": (lambda h: of_factor(0.7 / (h - 0.9)), 1.6),  # effect linear in the level
    "erosion": (lambda h: of_factor(3.0 / h**3), 3.0 ** (1.0 / 3.0)),
    "uplift": (lambda h: of_factor(math.exp(10.0 * (3.7 - h))), 3.7),
    "backward-erosion": (lambda h: of_factor(None if h < 2.0 else 3.3 / h), 3.3),
    "slope": (lambda h: Outcome(True, None, said="no equilibrium") if h > 2.9 else of_factor(1.01 + 0.1 * (2.9 - h)), 2.9),
    "hyd-forces": (lambda h: of_factor(0.4 + 0.3 * h), None),  # grows from below 1: has begun at FROM
    "blanket": (lambda h: of_factor(None), None),
    "hyd-stresses": (lambda h: of_factor(8.0 / h), None),
}


def study_of(mechanisms, silent=lambda name, h: False):
    """All levels of the search of these mechanisms, and the outcomes there; how many rounds it took."""
    known, rounds = {}, 0
    while True:
        levels, _ = replay(SCAN, known, TOLERANCE)
        if all(level in known for level in levels):
            return known, rounds
        rounds += 1
        for level in levels:
            known.setdefault(level, {name: MECHANISMS[name][0](level) for name in mechanisms if not silent(name, level)})


def check_apart():
    """A slope that is looked at apart has the levels of the first round, and those that it asks for."""
    names = ["heave", "uplift", "slope"]
    known, slopes = {}, set()
    while True:
        levels, of_slope = replay(SCAN, known, TOLERANCE, slopes)
        if all(level in known for level in levels) and slopes.issuperset(of_slope):
            break
        slopes.update(of_slope)
        for level in levels:
            known[level] = {name: MECHANISMS[name][0](level) for name in names if name != "slope" or level in slopes}
    for name in names:
        found = search(name, known, (FROM, TO))
        expect(f"{name}, with a slope apart", True, found.holds <= MECHANISMS[name][1] <= found.fails <= found.holds + TOLERANCE * (1.0 + 1e-9))
    expect("the slope has its own levels", (True, True), (set(SCAN) < slopes, slopes < set(levels)))
    alone, _ = study_of(["slope"])
    expect("those that it has alone", set(alone), slopes)


def check_search():
    kinds = {"hyd-forces": "below", "blanket": "absent", "hyd-stresses": "above"}
    for name, (_, exact) in MECHANISMS.items():
        known, rounds = study_of([name])
        found = search(name, known, (FROM, TO))
        expect(f"{name}: what is found", kinds.get(name, "between"), found.kind)
        if exact is None:
            expect(f"{name}: no further rounds", 1, rounds)
            continue
        expect(f"{name}: the bracket has the level, and is as narrow as asked for", True,
               found.holds <= exact <= found.fails and found.fails - found.holds <= TOLERANCE * (1.0 + 1e-9))
        expect(f"{name}: {rounds} rounds are at most 12", True, rounds <= 12)
    known, rounds = study_of(["heave"])
    expect_near("heave: a straight line is met exactly", 1.6, crossing("heave", known, search("heave", known, (FROM, TO))), 1e-9)
    expect("heave: in two rounds", 2, rounds)
    together, _ = study_of(MECHANISMS)
    for name, (_, exact) in MECHANISMS.items():
        found = search(name, together, (FROM, TO))
        if exact is not None:
            expect(f"{name}, with all others", True, found.holds <= exact <= found.fails <= found.holds + TOLERANCE * (1.0 + 1e-9))
    known, _ = study_of(["heave"], lambda name, h: h > 3.9)
    expect("the end without an answer does not hide a crossing", "between", search("heave", known, (FROM, TO)).kind)
    known, _ = study_of(["hyd-stresses"], lambda name, h: h > 3.9)
    expect("what is not known at TO is not above TO", "unknown", search("hyd-stresses", known, (FROM, TO)).kind)
    so_far = {level: found for level, found in known.items() if level < 3.0}
    expect("nor what is not made yet", "unknown", search("hyd-stresses", so_far, (FROM, TO)).kind)
    known, rounds = study_of(["heave"], lambda name, h: 1.0 < h < 1.75)
    expect("levels without an answer end the search", "between", search("heave", known, (FROM, TO)).kind)


# Bounds of Clopper and Pearson, 95 %: from published tables, and closed forms for none and all.
BOUNDS = [((0, 10), (0.0, 0.3085)), ((1, 10), (0.0025, 0.4450)), ((5, 10), (0.1871, 0.8129)), ((10, 10), (0.6915, 1.0)),
          ((3, 20), (0.0321, 0.3789)), ((0, 100), (0.0, 0.0362))]


def check_bounds():
    for counts, (low, high) in BOUNDS:
        found = bounds(*counts)
        expect_near(f"{counts}: low", low, found[0], 5e-5)
        expect_near(f"{counts}: high", high, found[1], 5e-5)
    expect_near("none of 7", 1.0 - 0.025 ** (1.0 / 7.0), bounds(0, 7)[1], 1e-6)
    intervals = [bounds(failures, 30) for failures in range(31)]
    for probability in (0.03, 0.2, 0.5):
        inside = sum(binom.pmf(failures, 30, probability) for failures, (low, high) in enumerate(intervals) if low <= probability <= high)
        # 95 % or more; counts are whole, so it may be nearly all.
        expect(f"{inside} of all samples have {probability} within their bounds", True, 0.95 <= inside <= 0.9975)


def study(scene, **variables):
    """The study of a scene, or what is said of it."""
    for name in ("BOUNDARY", "STEADY", "SET", "FACTOR"):
        os.environ[name] = variables.get(name, "")
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "scene.toml"
        path.write_text(scene, encoding="utf-8")
        (path.parent / "flood.csv").write_text("t,head\n0,1\n10,3\n20,0.5\n", encoding="utf-8")
        found = answer(Study, path)
        return found.replace(str(path), "SCENE") if isinstance(found, str) else found


SCENE = """
[[boundary]]
on = "river"
head = [[0.0, 1.0], [10.0, 3.0], [20.0, 0.0]]
[[boundary]]
on = "land"
head = 0.5
[[boundary]]
on = "face"
seepage_face = true
[[boundary]]
on = "gauge"
file = "flood.csv"
concentration = 0.0
[time]
end = 100.0
"""


def level_in(study, cells):
    return study.level_of(dict(zip(study.keys, cells)))


def check_scenes():
    river = study(SCENE, BOUNDARY="river")
    expect("a hydrograph is stretched from its first head", "[[0.0, 1.0], [10.0, 5.0], [20.0, -1.0]]", river.cells(5.0)[0])
    expect("its level is read back", 5.0, level_in(river, river.cells(5.0)))
    expect("it runs as the scene says", ({}, "all"), (river.changes(), river.states))
    steady = study(SCENE, BOUNDARY="river", STEADY="1", SET="time.end=3 a.b={x = [1, 2], y = 'z z'}")
    expect("or stands for ever", ("5.0", "start"), (steady.cells(5.0)[0], steady.states))
    expect("with keys of one's own", {"initial.flow": '"steady"', "time.end": "3", "output.every": "3", "output.snapshot_every": "3",
                                      "a.b": "{x = [1, 2], y = 'z z'}"}, steady.changes())
    gauge = study(SCENE, BOUNDARY="gauge")
    expect("a table in a file", ("boundary[3]", '{on = "gauge", concentration = 0.0, head = [[0.0, 1.0], [10.0, 5.0], [20.0, 0.0]]}'),
           (gauge.keys[0], gauge.cells(5.0)[0]))
    expect("its level is read back", 5.0, level_in(gauge, gauge.cells(5.0)))
    land = study(SCENE, BOUNDARY="land")
    expect("a constant head", ("boundary[1].head", "2.5", "1"), (land.keys[0], land.cells(2.5)[0], land.changes()["time.end"]))
    known = 'a boundary with a head: "river" or "land" or "gauge"'
    expect("no such boundary", f'BOUNDARY: got "rivr", which is no boundary of SCENE; expected {known}', study(SCENE, BOUNDARY="rivr"))
    expect("a boundary without a head", f'BOUNDARY: got "face", which has no head; expected {known}', study(SCENE, BOUNDARY="face"))
    expect("no boundary", f"BOUNDARY: got nothing; expected {known}", study(SCENE))
    expect("a change of the head", "SET: boundary[1].head: got the head that this study varies; expected other keys",
           study(SCENE, BOUNDARY="land", SET="boundary[1].head=3"))
    expect("no change", "SET: got 'x'; expected KEY=VALUE, with spaces between several", study(SCENE, BOUNDARY="land", SET="x"))
    expect("a level below the first head", "FROM: got 0.5; expected a level above 1 m, the first head of the table",
           answer(river.check_levels, "FROM", [0.5, 2.0]))


# A river at two boundaries, and a ditch.
WATERS = """
[[boundary]]
on = "bank"
head = RIVER
[[boundary]]
on = "river bed"
head = RIVER
[[boundary]]
on = "ditch"
head = 0.5
[[boundary]]
on = "shaft"
file = "flood.csv"
[[boundary]]
on = "well"
file = "flood.csv"
"""


def check_waters():
    """Boundaries of the same water rise together."""
    steady, flood = WATERS.replace("RIVER", "0.8"), WATERS.replace("RIVER", "[[0, 1], [10, 3]]")
    both = study(steady, BOUNDARY="bank river bed")
    expect("both get the level", (["boundary[0].head", "boundary[1].head"], ["2.5", "2.5"], []), (both.keys, both.cells(2.5), both.said_of_equal()))
    expect("which is read back, if both have it", (2.5, None), (level_in(both, ["2.5", "2.5"]), level_in(both, ["2.5", "0.8"])))
    expect("a head that is the same number is warned of", ['"river bed" has the head of "bank" in the scene, 0.8 m, and keeps it at all levels; '
           'if it borders the same water, the result is not safe: give BOUNDARY="bank river bed"'], study(steady, BOUNDARY="bank").said_of_equal())
    expect("unless SET gives it", [], study(steady, BOUNDARY="bank", SET="boundary[1].head=0.8").said_of_equal())
    expect("another number is other water", [], study(steady, BOUNDARY="ditch").said_of_equal())
    expect("tables are stretched together", ["[[0, 1.0], [10, 5.0]]"] * 2, study(flood, BOUNDARY="river bed bank").cells(5.0))
    for variables in ({}, {"STEADY": "1"}):
        expect("the same table is the same water", 'BOUNDARY: got "bank" without "river bed", which has the same table of heads and would keep its '
               'level; expected BOUNDARY="bank river bed", or another boundary[1].head in SET', study(flood, BOUNDARY="bank", **variables))
    expect("or that of the study", ["boundary[0].head"], study(flood, BOUNDARY="bank", SET="boundary[1].head=1").keys)
    expect("and so is the same file", 'BOUNDARY: got "shaft" without "well", which has the same file and would keep its level; '
           'expected BOUNDARY="shaft well", or another boundary[4] in SET', study(steady, BOUNDARY="shaft"))
    expect("files together", (["boundary[3]", "boundary[4]"], 5.0), ((pair := study(steady, BOUNDARY="well shaft shaft")).keys[::-1],
                                                                       level_in(pair, pair.cells(5.0))))
    expect("a table and a number", 'BOUNDARY: got "shaft" and "ditch", of which one has a table of heads and one a number; expected boundaries of '
           "one kind, or STEADY=1", study(steady, BOUNDARY="shaft ditch well"))
    expect("stand together for ever", ['{on = "shaft", head = 3.0}', "3.0", '{on = "well", head = 3.0}'],
           study(steady, BOUNDARY="shaft ditch well", STEADY="1").cells(3.0))
    expect("one that is none", True, study(steady, BOUNDARY="bank bed").startswith('BOUNDARY: got "bed", which is no boundary of SCENE; '))


SLOPE_SCENE = """
[[boundary]]
on = "river"
head = 2.0
[soil.levee.skeleton]
law = "mohr-coulomb"
young = [[1.0, 2e7], [0.0, 1e7]]
poisson = 0.3
friction = 30
[soil.cover]
like = "levee"
[soil.rock.skeleton]
law = "rigid"
"""


def check_elastic():
    """In runs beside which the slope is looked at, soil that could fail is elastic."""
    def elastic(scene=SLOPE_SCENE, **variables):
        changes = study(scene, BOUNDARY="river", **variables).elastic_changes()
        return changes if changes is None else {key: value for key, value in changes.items() if key.startswith("soil")}
    table = '{law = "elastic", young = [[1.0, 20000000.0], [0.0, 10000000.0]], poisson = 0.3}'
    expect("elastic soil has the moduli of the scene", {"soil.levee.skeleton": table, "soil.cover.skeleton": table}, elastic())
    expect("and those of SET", {"soil.levee.skeleton": '{law = "elastic", young = 5.0, poisson = 0.3}', "soil.rock.erosion.rate": "1",
                                "soil.cover.skeleton": '{law = "elastic", young = 5.0, poisson = 0.3}'},
           elastic(SET="soil.levee.skeleton.young=5.0 soil.levee.skeleton.friction=20 soil.rock.erosion.rate=1"))
    expect("which may make soil rigid", {"soil.levee.skeleton": table, "soil.cover.skeleton": '{law="rigid"}'}, elastic(SET='soil.cover.skeleton={law="rigid"}'))
    for what, scene, variables in (("no strength", SLOPE_SCENE.replace("mohr-coulomb", "elastic"), {}), ("another law", SLOPE_SCENE.replace("mohr-coulomb", "cam-clay"), {}),
                                   ("other states", SLOPE_SCENE, {"FACTOR": "last"}), ("a run goes on", SLOPE_SCENE + "[initial]\nfrom = 'x'\n", {}),
                                   ("a whole soil is set", SLOPE_SCENE, {"SET": "soil.cover={like='rock'}"})):
        expect(f"not apart: {what}", None, elastic(scene, **variables))


# Tables of `suffuse-post check`, and what they say: with units in brackets, in parentheses, in a line of their own, or without.
CHECKS = [header + "heave,toe,i_cr,0,1,2,2.0,0,0\nheave,base,i_cr,0,4,2,0.5,0,0\nuplift,cover,,,,,,,\nfilter,a to b,,,,,0.4,,\n" for header in (
    "mechanism,where,clause,t [s],effect,resistance,factor [-],x [m],y [m]\n",
    "mechanism,where,clause,t (s),effect,resistance,factor (-),x (m),y (m)\n",
    "mechanism,where,clause,t,effect,resistance,factor,x,y\n#,,,s,,,,m,m\n",
    "mechanism,where,clause,t,effect,resistance,factor,x,y\n")]
# Status, message of the run, message of the strength reduction, factor, states asked for; whether the slope fails, and its factor.
SLOPES = [
    ("done", "", "", "1.3", "last", (False, 1.3)),
    ("done", "", "", "0.8", "last", (True, 0.8)),
    ("done", "", "no soil has a strength", "", "last", None),
    ("done", "", "r at t = 0 s: there is no factor of safety: the soil fails, even with 0.01 times its strength", "", "last", (True, None)),
    ("failed", "suffuse-solver: error: t = 3 s: the soil has lost its equilibrium: it cannot carry", "", "1.1", "last", (True, None)),
    ("failed", "suffuse-solver: error: t = 3 s: the soil has lost its equilibrium: it cannot carry", "", "1.1", "start", (False, 1.1)),
    ("failed", "suffuse-solver: error: the soil has no equilibrium at the start: it cannot", "", "0.9", "start", (True, 0.9)),
    ("failed", "suffuse-solver: error: no step is short enough", "", "", "last", None),
    ("unfinished", "stopped", "", "1.3", "last", None),
    ("failed", "t = 3 s: no step has a solution, however short the step is: soil that yields is about to lose its equilibrium", "", "1.1", "last", (True, None)),
    ("failed", "the loaded surface moves to (3, -1), which is far outside the mesh; make the mesh larger", "", "1.1", "last", (True, None)),
    ("failed", "solid point 7 moves from (1, 2) to (3, -1), which is far outside the mesh; make", "", "", "checks", (True, None)),
    ("failed", "boundary left: a well lies far outside the mesh", "", "", "checks", None),
]
# Rows of history.csv; states asked for; whether the slope, with a factor of 1.2 in the last state, fails, and what is said.
HISTORIES = [
    ("0,0,0,0\n100,0.001,0,0\n", "last", (False, "")),
    ("0,0,0,0\n100,0.9,0.3,99.5\n200,1.2,0,99.5\n300,1.1,0,250\n", "last", (True, "the soil lost its equilibrium at t = 99.5 s, and moved by up to 1.2 m")),
    ("0,0,0,0\n1,0.7,0.9,0\n200,2,0,0\n", "all", (True, "the soil had no equilibrium at t = 0 s, and moved by up to 2 m")),
    ("0,0,0,0\n100,0.9,0.3,99.5\n", "start", (False, "")),
]


def check_outcomes():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        stem = folder / "0001" / "0001"
        stem.parent.mkdir()
        (folder / "assess.inputs").write_text("")
        os.utime(folder / "assess.inputs", (1.0, 1.0))
        for text in CHECKS:
            stem.with_name("0001.check.csv").write_text(text)
            found = checks_of(stem)
            expect("the worst place counts, with or without units", (True, 0.5, "base"),
                   (found["heave"].fails, found["heave"].factor, found["heave"].place))
            expect("an empty factor is none", (False, None), (found["uplift"].fails, found["uplift"].factor))
        for word, message, said, factor, states, expected in SLOPES:
            stem.with_name("0001.status").write_text(word)
            os.utime(stem.with_name("0001.status"), (1.0, 1.0))
            stem.with_name("0001.assessed").write_text(f"factor: {said}\n" if said else "")
            stem.with_name("0001.factors.csv").write_text(f"t,factor\n0,{factor}\n")
            found, _ = outcomes_of(folder, "0001", word, message, states)
            slope = found.get("slope")
            expect(f"slope: {word} {message} {said} {factor}", expected, slope and (slope.fails, slope.factor))
            if word == "failed":
                expect("a run that failed has shown its start, or what had begun, and filters are no mechanism of a level",
                       {"heave", "uplift"} if states == "start" else {"heave"}, found.keys() - {"slope"})


def check_followed():
    """A run that follows soil that failed, until it rests, ends well; the slope has failed."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        stem = folder / "0001" / "0001"
        stem.with_name("0001.results").mkdir(parents=True)
        for suffix, text in (("check.csv", CHECKS[-1]), ("status", "done"), ("factors.csv", "t,factor\n300,1.2\n")):
            stem.with_name(f"0001.{suffix}").write_text(text)
        (folder / "assess.inputs").write_text("")
        stem.with_name("0001.assessed").write_text("")
        for rows, states, expected in HISTORIES:
            (stem.with_name("0001.results") / "history.csv").write_text("t,displacement_max,inertia,failure_time\n" + rows)
            slope = outcomes_of(folder, "0001", "done", "", states)[0]["slope"]
            expect(f"a followed failure: {rows!r} {states}", expected, (slope.fails, slope.said))


def check_creep():
    """Soil that moves far in equilibrium holds, with a warning."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "runs"
        stem = folder / "0001" / "0001"
        stem.with_name("0001.results").mkdir(parents=True)
        for suffix, text in (("check.csv", CHECKS[-1]), ("status", "done"), ("assessed", "")):
            stem.with_name(f"0001.{suffix}").write_text(text)
        (folder / "assess.inputs").write_text("")
        os.utime(folder / "assess.inputs", (1.0, 1.0))
        os.utime(stem.with_name("0001.status"), (1.0, 1.0))

        def said(moved, factor=1.003, failed=0):
            (stem.with_name("0001.results") / "history.csv").write_text(f"t,displacement_max,failure_time\n0,0,0\n9,{moved},{failed}\n")
            stem.with_name("0001.factors.csv").write_text(f"t,factor\n9,{factor}\n")
            slope = outcomes_of(folder, "0001", "done", "", "last")[0]["slope"]
            return slope.fails, slope.said

        creeps = "the soil moved by 1.07 m, in equilibrium: it may slide slowly, and the moment of failure depends on the mesh"
        expect("a run without a warning does not creep", (False, ""), said(1.07))
        warning = "the soil has moved by 0.07 m in equilibrium by t = 3 s, more than 1 % of its height: it may slide slowly"
        (stem.with_name("0001.results") / "run.json").write_text(json.dumps({"warnings": ["soil is coarse", warning]}))
        expect("one with a warning does", (False, creeps), said(1.07))
        expect("soil that fails does not creep", [(True, ""), True], [said(1.07, 0.9), "lost its equilibrium" in said(1.07, 1.1, 5)[1]])
        # What a study says of it.
        said(1.07)
        runs, known = {2.0: {"run": "0001"}}, {2.0: {"slope": Outcome(False, 1.003)}}
        creeping = lambda scene, **variables: creep_of_runs(study(scene, BOUNDARY="river", **variables), pathlib.Path(name), runs, known)
        expect("runs that creep", {2.0: 1.07}, creeping(SLOPE_SCENE, FACTOR="last"))
        expect("elastic runs do not", [{}, {}], [creeping(SLOPE_SCENE), creeping(SLOPE_SCENE.replace("mohr-coulomb", "elastic"), FACTOR="last")])
        known[2.0]["slope"].fails = True
        expect("nor those that fail", {}, creeping(SLOPE_SCENE, FACTOR="last"))
    expect("the report warns of the first and the worst", ["- Warning: slope: " + creeps.replace("1.07 m", "0.2 m at a level of 3 m and 1.07 m at a level of 9.5 m") + "."],
           said_of_creeping({9.5: 1.07, 3.0: 0.2, 6.0: 0.5}))
    expect("or of none", [], said_of_creeping({}))


def check_absent():
    heave, slope = Outcome(True, 0.5), Outcome(False, 1.2)
    runs = {1: ({"slope": slope}, True), 2: ({"heave": heave, "slope": slope}, True), 3: ({"slope": slope}, False), 4: ({}, True)}
    found = with_absent(runs)
    expect("no row of a mechanism that others have: it does not act", Outcome(False), found[1].get("heave"))
    expect("but a run that failed says nothing of it", None, found[3].get("heave"))
    expect("any of them fails, does not, or is not known", [Outcome(False), Outcome(True), None],
           [with_any(run, ["heave", "slope"]).get("any of them") for run in (found[1], found[2], found[3])])
    expect("and there is no slope that was not looked at", {"heave"}, set(found[4]))
    both = ["erosion", "heave"]
    expect("erosion alone is no breach", (True, False), tuple(
        with_any({"erosion": Outcome(True), "heave": Outcome(False)}, both)[name].fails for name in ("any of them", "any but erosion")))
    expect("nor known to be none", {"erosion", "any of them"}, set(with_any({"erosion": Outcome(True)}, both)))
    expect("without erosion, or with nothing else, there is no such line", [["any of them"], []],
           [list(groups_of(names)) for names in (["heave", "slope"], ["erosion"])])


# Of filters, gradations and losses, in two runs.
OTHERS = ["mechanism,where,factor\nheave,toe,0.5\nloss,sand,\nfilter,sand -> lens,2\nfilter,lens -> sand,0.9\nfilter-drainage,sand -> lens,0.434\n"
          f"filter-retention,sand -> lens,3\ninternal-stability,sand,{last}\n" for last in (0.8, 1.2)]


def check_others():
    with tempfile.TemporaryDirectory() as name:
        stems = [pathlib.Path(name) / run for run in ("0001", "0002")]
        for stem, text in zip(stems, OTHERS):
            stem.with_name(f"{stem.name}.check.csv").write_text(text)
        expect("checks that do not depend on the level are said once, with factor and place",
               "filter lens -> sand has a factor of 0.9 and is exceeded; filter drainage sand -> lens has a factor of 0.434 and is exceeded; "
               "internal stability sand has a factor of 0.8 to 1.2 and is exceeded in 1 of 2 runs; filter retention holds", said_of_others(stems))
        stems[0].with_name("0001.check.csv").write_text("mechanism,where,factor\nfilter,a,2\nfilter-retention,a,3\n")
        expect("or that they hold", "filter and filter retention hold", said_of_others(stems[:1]))
        stems[0].with_name("0001.check.csv").write_text("mechanism,where,factor\nheave,toe,0.5\nloss,sand,\n")
        expect("and nothing of none", "", said_of_others(stems[:1]))


def reduction(region="", deeper="", quadratic="", keys=(), states="start", **scene):
    os.environ |= {"REGION": region, "DEEPER": deeper, "QUADRATIC": quadratic}
    found = answer(reduction_options, {"gravity": [0.0, -9.81], "soil": SOILS} | scene, list(keys), states)
    os.environ |= dict.fromkeys(("REGION", "DEEPER", "QUADRATIC"), "")
    return found


SOILS = {"sand": {"skeleton": {"law": "mohr-coulomb"}}, "clay": {"like": "sand"}, "rock": {"skeleton": {"law": "rigid"}}, "fill": {"like": "rock"}, "a b": {}}


def check_reduction():
    expect("no options", [], reduction())
    expect("soils that fail, in the order of their names, and a depth", "--region clay --region sand --deeper 0.5",
           " ".join(reduction("sand clay sand", "0.50")))
    expect("said as", "only clay and sand can fail, other soil is elastic, and bodies within 0.5 m of the surface are left out",
           said_of_options(reduction("sand clay", "0.5")))
    expect("quadratic displacements", "--deeper 0.5 --quadratic", " ".join(reduction("", "0.5", "1")))
    expect("not by 0", [], reduction("", "", "0"))
    expect("said as", "displacements are quadratic", said_of_options(reduction("", "", "1")))
    expect("another word", "QUADRATIC: got 'yes'; expected 1 for quadratic displacements, or 0", reduction("", "", "yes"))
    expect("without a factor", "QUADRATIC: got '1' without FACTOR; expected FACTOR=1, all or start beside it", reduction("", "", "1", states=""))
    soils = "expected soils with a strength, with spaces between several: clay or sand"
    expect("no such soil", f"REGION: got 'sant'; {soils}; did you mean sand?", reduction("sant"))
    expect("soil that does not fail", f"REGION: got 'fill'; {soils}", reduction("fill"))
    expect("unless it gets a strength", ["--region", "fill"], reduction("fill", keys=["soil.rock.skeleton.law"]))
    for text in ("0", "-1", "nan", "inf", "deep"):
        expect("a depth that is none", f"DEEPER: got '{text}'; expected a depth above 0, m", reduction("", text))
    expect("a depth without weight", "DEEPER: got '1'; expected a scene with gravity; this one has none", reduction("", "1", gravity=[0.0, 0.0]))
    expect("no factor", "REGION: got 'sand' without FACTOR; expected FACTOR=1, all or start beside it", reduction("sand", states=""))
    expect("checks alone", "DEEPER: got '1' with FACTOR=checks; expected FACTOR=start, last or all beside it", reduction("", "1", states="checks"))


def check_warnings():
    with tempfile.TemporaryDirectory() as name:
        folder, rows = pathlib.Path(name), [{"run": f"000{number}"} for number in range(1, 4)]
        for row, level in zip(rows, (1, 200, 300)):
            stem = folder / "runs" / row["run"] / row["run"]
            stem.parent.mkdir(parents=True)
            head = f"suffuse-mesher: warning: --set boundary[0].head={level}: boundary[0].head: {level} m is much\n" if level > 1 else ""
            stem.with_name(f"{stem.name}.log").write_text(f"x.case.h5\n{head}suffuse-solver: warning: soil2 is coarse\n" + head)
            stem.with_name(f"{stem.name}.assessed").write_text("warning: suction up to 5 Pa\nfactor: none: warning: no\n" if level == 1 else "")
        expect("warnings of the runs, each once", ["warning: soil2 is coarse (3 of 3 runs)", "warning: suction up to 5 Pa (1 of 3 runs)",
               "warning: boundary[0].head: 200 m is much (2 of 3 runs; these are the numbers of 0002)"], named_warnings(folder, rows))
        expect("a run that was not made has none", [], named_warnings(folder, [{"run": "0009"}]))


def check_charts():
    with tempfile.TemporaryDirectory() as name:
        path = pathlib.Path(name) / "chart.svg"
        known = {level: {"heave": of_factor(9.0 - level), "uplift": of_factor(6.0 - level), "slope": of_factor(2.0 - level)} for level in (1.0, 4.0)}
        draw(path, known, ["heave", "uplift", "slope"], [{"mechanism": "slope", "level": "1"}])
        entries = [line.partition(">")[2].removesuffix("</text>") for line in path.read_text().splitlines() if line.startswith("<text")]
        expect("a curve above the chart is said to be there", ["heave, above 4", "uplift", "slope, from 1 m"], entries[-3:])
        names = ["heave", "uplift", "slope", "any of them"]
        table = [[name, level, 1, 0, "0" if place < 2 else f"{0.2 * place}", "0", "0.9", 0] for place, name in enumerate(names) for level in ("2.6", "4.4")]
        draw_chart(path, table, names, [2.6, 4.4])
        text = path.read_text()
        sides = [float(line.partition("M")[2].split()[0]) for line in text.splitlines() if line.startswith('<g clip-path')]
        expect("equal curves are one, which is said", (3, True), (len(sides), "Mechanisms with the same numbers share a curve." in text))
        expect("points are at most 1 % of the axis beside their level", True, max(sides) - min(sides) <= 0.02 * WIDTH + 0.1)
        expect("and the axis has the levels", [">2.6<", ">4.4<"], [mark for mark in (">2.6<", ">3<", ">4.4<") if mark in text])
    expect("each mechanism has a curve of its own, and so have two groups", True, len(CURVES) >= len(ON_LEVEL) + 2)


finish("levels, probabilities and what runs say of them", globals())

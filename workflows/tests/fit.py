#!/usr/bin/python3
"""Does a calibration find values that are known, with intervals that hold them, and say what it cannot know? Formulas stand
in for the runs. Prints what fails."""

import math
import pathlib
import random
import tempfile

import numpy

from expectations import answer, expect, expect_near, finish
from estimator import NoRun, derivatives, mark_not_linear, search, uncertainty
from keys import Key, split_keys, value_in
from measured import computed, read_measured

SEEDS = 20
FREE = math.inf
# A test in a permeameter, with two soils that erode by a law of first order: how long the gradients stay, s.
GRADIENTS, STAGE = (0.5, 1.0, 2.0, 4.0), 900.0
TIMES = numpy.arange(300.0, 3601.0, 300.0)
TRUE = {"rate": 2e-4, "threshold": 0.6, "rate of the other": 5e-4, "threshold of the other": 1.5}
DEVIATION = 5e-3


def drives(threshold):
    """The integral of the drive above its threshold until each time."""
    return sum(max(gradient - threshold, 0.0) * numpy.clip(TIMES - k * STAGE, 0.0, STAGE) for k, gradient in enumerate(GRADIENTS))


def losses(values):
    """Shares of the fines that two soils have lost, one after the other."""
    return numpy.concatenate([1.0 - numpy.exp(-values[k] * drives(values[k + 1])) for k in range(0, len(values), 2)])


class Model:
    """Stands in for runs. `fails(values)`: whether the run with these values fails."""

    def __init__(self, starts, measured, model=losses, scale=DEVIATION, fails=lambda values: False, bounds=None, parts=None):
        self.parts = parts
        bounds = bounds or [(-FREE, FREE)] * len(starts)
        self.keys = [Key(f"key {j}", start, *bound, "") for j, (start, bound) in enumerate(zip(starts, bounds))]
        self.measured, self.model, self.scale, self.fails = measured, model, scale, fails
        self.low, self.high = [key.x_of(key.low) for key in self.keys], [key.x_of(key.high) for key in self.keys]
        self.batches, self.bad = [], 0

    def values(self, x):
        return [float(key.text_at(part)) for key, part in zip(self.keys, x)]

    def evaluate(self, points, purpose):
        self.batches.append((purpose, len(points)))
        found = []
        for values in map(self.values, points):
            bad = self.fails(values)
            self.bad += bad
            found.append(None if bad else (self.model(values) - self.measured) / self.scale)
        return found

    def search(self):
        spread = float(numpy.sum((self.measured - numpy.mean(self.measured)) ** 2)) / self.scale**2
        return search(self.evaluate, [key.logarithmic for key in self.keys], self.low, self.high, spread)

    def known(self, found, has_deviations=True, at_bound=()):
        around = derivatives(self.evaluate, self.low, self.high, found.x)
        return uncertainty(around, found.residuals, numpy.full(len(self.measured), 1e-9 / self.scale), has_deviations, at_bound, self.parts)


def check_intervals():
    for has_deviations in (True, False):
        expect_intervals(has_deviations)


def expect_intervals(has_deviations):
    """Four keys of two soils at once, twenty seeds."""
    true = list(TRUE.values())
    offs = []
    for seed in range(SEEDS):
        generator = random.Random(seed)
        measured = numpy.array([generator.gauss(value, DEVIATION) for value in losses(true)])
        model = Model([1e-4, 0.3, 1e-3, 1.0], measured, scale=DEVIATION if has_deviations else 1.0)
        found = model.search()
        known = model.known(found, has_deviations)
        expect("no kink is found where there is none", {}, known.kinks)
        offs.append([(abs(found.x[j] - math.log(true[j] / key.start)) / known.error[j], known.quantile) for j, key in enumerate(model.keys)])
    for j, name in enumerate(TRUE):
        if has_deviations:  # otherwise Student's distribution is wider
            expect(f"{name}: within 3 standard errors", SEEDS, sum(off[j][0] <= 3.0 for off in offs))
        within = sum(off[j][0] <= off[j][1] for off in offs)
        expect(f"{name}: within its 95 % interval for 17 of 20 seeds ({within})", True, within >= 17)
    # Errors that are too large would pass the checks above.
    mean = math.sqrt(numpy.mean([off[0] ** 2 for line in offs for off in line]))
    expect_near(f"root mean square in standard errors, deviations given: {has_deviations}", 1.0, mean, 0.25)


def check_exact():
    true = list(TRUE.values())
    model = Model([1e-4, 0.3, 1e-3, 1.0], losses(true))
    for value, wanted in zip(model.values(model.search().x), true):
        expect_near("a value without noise, as a share", 1.0, value / wanted, 1e-6)
    expect("the runs of derivatives are asked for at once", {9}, {count for purpose, count in model.batches if purpose == "derivative"})
    # A line: the standard errors are those of linear regression.
    t = numpy.arange(1.0, 6.0)
    measured = numpy.array([1.1, 1.9, 3.2, 3.9, 5.1])
    line = Model([-1.0, 2.0], measured, lambda values: values[0] + values[1] * t, 1.0, bounds=[(-5.0, 5.0), (-5.0, 5.0)])
    found = line.search()
    slope, rest = numpy.polyfit(t, measured, 1), measured - numpy.polyval(numpy.polyfit(t, measured, 1), t)
    known = line.known(found, False)
    spread = math.sqrt(rest @ rest / 3.0 / numpy.sum((t - 3.0) ** 2))
    expect_near("the slope of a line", slope[0], line.values(found.x)[1], 1e-6)
    expect_near("its standard error", spread, known.error[1] * line.keys[1].scale, 1e-8)
    expect_near("its correlation with the other", -3.0 / math.sqrt(11.0), known.correlations[0, 1], 1e-8)
    expect_near("half of its interval, by Student's t with 3 degrees", 3.1824463, known.quantile, 1e-6)


def check_starts():
    """All fines have left before the first point, so that rates respond to nothing where the search starts."""
    true = [2e-4, 0.6]
    model = Model([0.4, 0.6], losses(true), bounds=[(-FREE, FREE), (0.5, 0.7)])
    found = model.search()
    expect("another start is taken", 2, found.starts)
    expect_near("and finds the rate", 1.0, model.values(found.x)[0] / true[0], 1e-4)
    model = Model([1e-4, 0.3], losses(true), fails=lambda values: values[0] > 2.01e-4)
    found = model.search()
    expect("runs that fail", True, model.bad > 0)
    expect_near("are gone round", 1.0, model.values(found.x)[0] / true[0], 1e-4)
    model = Model([5e-4, 0.3], losses(true), fails=lambda values: values[0] > 4e-4)
    expect_near("a start that fails", 1.0, model.values(model.search().x)[0] / true[0], 1e-4)
    try:
        Model([5e-4, 0.3], losses(true), fails=lambda values: True).search()
        expect("no run at all", "NoRun", "a result")
    except NoRun:
        pass


def check_unknown():
    true = [2e-4, 0.6]
    measured = losses(true)
    noise = numpy.array([random.Random(7).gauss(0.0, DEVIATION) for _ in measured])
    product = Model([1e-4, 0.3, 2.0], measured + noise, lambda values: losses([values[0] * values[2], values[1]]))
    known = product.known(product.search())
    expect("two keys whose product acts alone", (["not told apart", "known", "not told apart"], [2, None, 0]), (known.said, known.with_whom))
    expect("no standard error of theirs", [True, False, True], list(numpy.isnan(known.error)))
    expect_near("their correlation", -1.0, known.correlations[0, 2], 1e-6)
    alone = Model([1e-4, 0.3], measured + noise)
    expect_near("the error of the third is that without them", alone.known(alone.search()).error[1], known.error[1], 1e-3)
    three = Model([1e-4, 0.3, 2.0, 3.0], measured, lambda values: losses([values[0] * values[2] * values[3], values[1]]))
    expect("three keys", ["not told apart", "known", "not told apart", "not told apart"], three.known(three.search()).said)
    mute = Model([1e-4, 0.3, 5.0], measured, lambda values: losses(values[:2]))
    found = mute.search()
    known = mute.known(found)
    expect("a key to which nothing responds", ["known", "known", "no response"], known.said)
    expect("stays at its start", 5.0, mute.values(found.x)[2])
    bounded = Model([1e-4, 0.4], measured, bounds=[(-FREE, FREE), (0.3, 0.5)])
    found = bounded.search()
    expect_near("a bound is reached", 0.5, bounded.values(found.x)[1], 1e-3)
    expect("and said", ["known", "at a bound"], bounded.known(found, at_bound=[1]).said)
    two = Model([1e-4, 0.3], measured[[4, 11]], lambda values: losses(values)[[4, 11]])
    expect("as many keys as points", ["as many keys as points"] * 2, two.known(two.search(), False).said)


def check_kinks():
    """Gradients that are raised in steps: below a threshold soil erodes in no step, or in one more."""
    true = [2e-4, 1.0]
    # Noise with which the search ends at a gradient that was applied.
    generator = random.Random(5)
    noise = numpy.array([generator.gauss(0.0, DEVIATION) for _ in TIMES])
    for has_deviations in (True, False):
        scale = DEVIATION if has_deviations else 1.0
        stepped = Model([1e-4, 0.7], losses(true) + noise, scale=scale)
        found = stepped.search()
        expect_near("the search ends at a gradient that was applied", 1.0, stepped.values(found.x)[1], 2e-3)
        known = stepped.known(found, has_deviations)
        expect("which is said of the threshold alone", ["known", "kink"], known.said)
        expect("it has no standard error", [False, True], list(numpy.isnan(known.error)))
        expect("smaller values do more", True, known.kinks[1].below > 1.2 * known.kinks[1].above)
    smooth = Model([1e-4, 0.7], losses([2e-4, 0.7]) + noise)
    found = smooth.search()
    known = smooth.known(found)
    mark_not_linear(smooth.evaluate, smooth.low, smooth.high, found, known, [numpy.arange(12)])
    expect("between two gradients there is none", ["known", "known"], known.said)
    # Above the last gradient nothing erodes, and the interval reaches there.
    near = Model([0.97], losses([2e-4, 0.98])[:6], lambda values: losses([2e-4, values[0]])[:6])
    found = near.search()
    known = near.known(found)
    error = known.error[0]
    expect("a kink beside the best value is not seen by derivatives", ["known"], known.said)
    mark_not_linear(near.evaluate, near.low, near.high, found, known, [numpy.arange(6)])
    expect("but by the ends of the interval", ["not linear"], known.said)
    expect("smaller values do more there", True, known.kinks[0].below > 1.5 * known.kinks[0].above)
    expect("the standard error stays", error, known.error[0])
    # Of two outputs the second has the kink. It counts for the key if the key acts on it.
    both = lambda share: lambda values: numpy.concatenate([values[1] * TIMES / 3600.0, share * losses(values)])
    parts = [numpy.arange(12), numpy.arange(12, 24)]
    for share, said in ((1.0, ["known", "kink"]), (0.05, ["known", "known"])):
        two = Model([2e-4, 1.0], both(share)(true), both(share), parts=parts)
        known = two.known(two.search())
        expect(f"two outputs, {share}", said, known.said)
        expect("the output is named", [1] if "kink" in said else [], [kink.output for kink in known.kinks.values()])
    # Responses to both sides differ by less than half, and yet neither lowers the misfit.
    t, across = numpy.arange(1.0, 13.0), numpy.tile([1.0, -1.0], 6)
    across = 2.0 * (across - (across @ t) / (t @ t) * t) / numpy.linalg.norm(across)
    corner = Model([1.0], t - 3.0 * across, lambda values: values[0] * t + 0.2 * abs(values[0] - 1.0) * numpy.linalg.norm(t) * across / 2.0, 1.0)
    known = corner.known(corner.search())
    expect("a corner of the misfit", (["kink"], None), (known.said, known.kinks[0].output if known.kinks else "no kink"))


def check_keys():
    expect("bounds", [("a.b", -FREE, FREE), ("c[0].d", 1.0, 2.0)], split_keys("a.b, c[0].d:1:2"))
    for text, message in (("", "got nothing"), ("a.b:c:1", "got 'a.b:c:1'"), ("a.b:1", "got 'a.b:1'"), ("a.b:2:1", "got 'a.b:2:1'"),
                          ("a.b,a.b", "got 'a.b' twice")):
        expect(f"refused: KEYS={text}", f"KEYS: {message}", str(answer(split_keys, text)).partition(";")[0])
    expect("positive keys", [True, True, False, False], [Key("", *numbers, "").logarithmic for numbers in
                                                         ((1.0, -FREE, FREE), (1.0, 0.5, 2.0), (1.0, 0.0, 2.0), (-1.0, -FREE, FREE))])
    scene = {"soil": {"a": {"erosion": {"rate": 1.0}}, "b": {"like": "a", "erosion": {"law": "none"}}}, "boundary": [{"head": 2.0}]}
    expect("values in a scene", [1.0, 1.0, 2.0, None, None],
           [value_in(scene, name) for name in ("soil.a.erosion.rate", 'soil."b".erosion.rate', "boundary[0].head", "boundary[1].head", "soil.c.x")])


def expect_tables(folder):
    path = folder / "points.csv"

    def read(text, against=()):
        path.write_text(text, encoding="utf-8")
        found = answer(read_measured, path, list(against))
        return found.replace(f"{path}", "points.csv") if isinstance(found, str) else found

    found = read("t,value,deviation\n2,3,0.1\n1,,0.1\n0,5,0.2\n", ["history.flux_out"])
    expect("a column value, an empty cell", ([2.0, 0.0], [3.0, 5.0], [0.1, 0.2]), (list(found.t), list(found.value), list(found.deviation)))
    found = read("t,ledger.eroded,boundary.my.top.discharge,probe[0].head\n0,1,2,7\n9,3,4,8\n", ["probe[0].head", "boundary.my.top.discharge"])
    expect("some of the columns, in the order asked for", (["probe[0].head", "boundary.my.top.discharge"], [7.0, 8.0, 2.0, 4.0]),
           (found.outputs, list(found.value)))
    (folder / "history.csv").write_text("t,dt,flux_out\n0,1,4\n10,1,6\n", encoding="utf-8")
    expect("outputs are linear between rows", [4.4, 4.0], list(computed(read("t,value\n2,3\n0,5\n", ["history.flux_out"]), folder)))
    for text, against, message in (
        ("", [], "points.csv: got no line; expected a line of columns and a line for each time"),
        ("t;value\n", [], 'points.csv:1: got "t;value"; expected commas between columns'),
        ("time,value\n1,2\n", [], "points.csv:1: got time,value; expected a column t of times in s"),
        ("t,t\n", [], 'points.csv:1: got "t" twice; expected each column once'),
        ("t,value\n1,2\n", [], "AGAINST: got 'nothing'; expected one output that the column value is of: "),
        ("t,value\n1,2\n", ["flux_out"], "AGAINST: got 'flux_out'; expected an output: history.NAME, "),
        ("t,flux\n1,2\n", [], "points.csv:1: got 'flux'; expected an output: history.NAME, "),
        ("t,history.flux_out\n1,2\n", ["history.flux_ot"],
         "points.csv:1: got t,history.flux_out; expected a column history.flux_ot"),
        ("t,value,history.dt\n", [], 'points.csv:1: got "value" and "history.dt"; expected a column value, or columns named as outputs'),
        ("t,ledger.eroded,ledger.solid,deviation\n", [], "points.csv:1: got deviation; expected OUTPUT.deviation for each of several outputs"),
        ("t,ledger.eroded,ledger.solid,ledger.solid.deviation\n", [],
         "points.csv:1: got no column ledger.eroded.deviation; expected deviations of all outputs or of none"),
        ("t,ledger.eroded\n1,2\n2,x\n-1,3\n", [],
         'points.csv:3: ledger.eroded: got "x"; expected a number\npoints.csv:4: t: got "-1"; expected a time of at least 0 s'),
        ("t,ledger.eroded\n1,2,3\n", [], "points.csv:2: got 3 cells; expected 2"),
        ("t,ledger.eroded,deviation\n1,2,0\n", [], 'points.csv:2: deviation: got "0"; expected a number above 0'),
        ("t,ledger.eroded,ledger.solid\n1,2,\n", [], "points.csv: ledger.solid: got no value; expected at least one"),
    ):
        found = read(text, against)
        expect(f"refused: {text!r}", message, found[: len(message)] if isinstance(found, str) else found)
    flat = read("t,ledger.eroded,ledger.solid\n1,2,3\n2,2,4\n")
    expect("an output without a spread, and another", True, "has no spread to weigh it by" in str(answer(flat.scale)))


def check_tables():
    with tempfile.TemporaryDirectory() as scratch:
        expect_tables(pathlib.Path(scratch))


finish("values and intervals of a calibration", globals())

#!/usr/bin/python3
"""Does the arithmetic of a study of convergence find orders and values that are known? Prints what fails."""

import itertools
import math
import operator

from expectations import expect, expect_near, finish
from richardson import ORDERS_OF_TOLERANCE, estimate


def refined(*ratios):
    """Sizes from 1 on, each finer by a ratio."""
    return list(itertools.accumulate((1.0, *ratios), operator.truediv))


REFINEMENTS = {"ratio 2": (2.0, 2.0), "ratios 1.5 and 1.7": (1.5, 1.7), "ratios 1.7 and 1.5": (1.7, 1.5),
               "ratios 1.1 and 3": (1.1, 3.0), "ratios 3 and 1.1": (3.0, 1.1), "four sizes": (2.0, 1.5, 1.7)}


def check_manufactured():
    for name, ratios in REFINEMENTS.items():
        sizes = refined(*ratios)
        for order in (0.5 + 1e-6, 0.7, 1.0, 1.53, 2.0, 3.0 - 1e-6):
            for limit, factor in ((2.0, 0.3), (-5.0, 0.2), (2.0, -0.3)):
                values = [limit + factor * size**order for size in sizes]
                found = estimate(sizes, values)
                what = f"{name}, order {order}, {limit} {factor:+} h^p"
                expect(what, "in range", found.kind)
                expect_near(f"{what}: order", order, found.order, 1e-8)
                expect_near(f"{what}: limit", limit, found.extrapolated, 1e-8)
                expect_near(f"{what}: index", 1.25 * abs((limit - values[-1]) / values[-1]), found.index, 1e-8)
                expect(f"{what}: order of the sizes", found, estimate(sizes[::-1], values[::-1]))


def check_published():
    """Celik and others (2008), Table 1, first column: 4500, 8000 and 18 000 elements of a plane, so finer by 1.333 and 1.5."""
    found = estimate(refined(math.sqrt(8000 / 4500), math.sqrt(18000 / 8000)), [5.863, 5.972, 6.063])
    expect("Celik: kind", "in range", found.kind)
    expect_near("Celik: order", 1.53, found.order, 0.005)
    expect_near("Celik: extrapolated", 6.1685, found.extrapolated, 0.00005)
    expect_near("Celik: index", 0.022, found.index, 0.0005)


# Values from the coarsest size on, where each size is half of the one before, and what is said of them.
REFUSED = [
    ("they oscillate", [1.0, 1.2, 1.1], "oscillating"),
    ("they go apart", [1.0, 1.1, 1.3], "diverging"),
    ("differences stay", [1.0, 1.125, 1.25], "diverging"),
    ("the coarser two agree", [1.0, 1.0, 1.3], "diverging"),
    ("order 0.3", [1.0 + 2.0**(-0.3 * k) for k in range(3)], "order"),
    ("order 4", [1.0 + 2.0**(-4 * k) for k in range(3)], "order"),
    ("the finer two agree", [1.0, 1.3, 1.3], "order"),
    ("the finest is 0", [3.0, 1.0, 0.0], "zero"),
    ("the coarsest does not fit", [1.0 + 8.0, 1.0 + 1.0, 1.0 + 0.5, 1.0 + 0.25], "index"),
    ("the coarsest oscillates", [1.0 + 0.9, 1.0 + 1.0, 1.0 + 0.5, 1.0 + 0.25], "oscillating"),
]


def check_refused():
    for what, values, kind in REFUSED:
        found = estimate(refined(*[2.0] * (len(values) - 1)), values)
        expect(what, (kind, False), (found.kind, found.in_range))
        expect(f"{what}: no value and no index", True, math.isnan(found.extrapolated) and math.isnan(found.index))
    # With ratios that differ, growing differences may converge, and falling ones diverge.
    sizes = refined(1.1, 3.0)
    expect("growing differences", "in range", estimate(sizes, [1.0 + size for size in sizes]).kind)
    sizes = refined(3.0, 1.1)
    expect("falling differences", "diverging", estimate(sizes, [1.0 + size**-0.5 for size in sizes]).kind)
    for what, values in (("constant", [0.3, 0.3, 0.3]), ("zero", [0.0, 0.0, 0.0]), ("round-off", [0.3, 0.3 + 1e-12, 0.3])):
        found = estimate(refined(2.0, 2.0), values)
        expect(what, ("constant", values[-1], 0.0, True), (found.kind, found.extrapolated, found.index, found.in_range))
    values = [1.0 + 4.0**(-0.4 * k) for k in range(3)]
    expect("order 0.4 of a size", "order", estimate(refined(4.0, 4.0), values).kind)
    expect("order 0.4 of a tolerance", "in range", estimate(refined(4.0, 4.0), values, ORDERS_OF_TOLERANCE).kind)


finish("orders, extrapolated values and indices of a study of convergence", globals())

"""Order, extrapolated value and grid convergence index of a series of values on finer and finer sizes.

The procedure is that of Celik and others (2008), "Procedure for estimation and reporting of uncertainty due to
discretization in CFD applications", ASME J. Fluids Eng. 130, 078001. It takes the three finest values; more sizes check
whether the coarser values follow the same order. The size may be that of elements or a tolerance of time steps.
"""

import dataclasses
import math

SAFETY = 1.25
# Orders that a series in its range of convergence has.
ORDERS_OF_SIZE = (0.5, 3.0)
# A step of a scheme of order q has a local error of dt^(q+1), so the error at the end is that of tolerance^(q/(q+1)):
# 1/2 for the first order, 2/3 for the second.
ORDERS_OF_TOLERANCE = (0.25, 2.0)
# Range of GCI_coarse / (r^p GCI_fine), which is 1 if the index falls with the order.
RATIOS = (0.5, 2.0)
# Differences below this share of the largest value are round-off, or that of an iteration.
NEGLIGIBLE = 1e-9
BISECTIONS = 100


@dataclasses.dataclass
class Estimate:
    """`kind` is "in range" or "constant", or says why there is no estimate: then the other fields are NaN."""

    kind: str
    order: float = math.nan  # the observed order, also where it is outside its range
    extrapolated: float = math.nan
    index: float = math.nan  # share of the finest value

    @property
    def in_range(self):
        return self.kind in ("in range", "constant")


def observed_order(ratio, fine, coarse):
    """The order p of f0 + C h^p whose differences have this `ratio`, coarse over fine. `fine`, `coarse`: ratios of sizes.

    The order is not positive where the ratio is at most log(coarse) / log(fine); then 0 is returned.
    """
    log_fine, log_coarse = math.log(fine), math.log(coarse)
    if ratio <= log_coarse / log_fine:
        return 0.0

    def excess(order):  # the ratio of the differences grows with the order
        return math.log(math.expm1(order * log_coarse) / math.expm1(order * log_fine)) + order * log_fine - math.log(ratio)

    low, high = 1e-9, min(100.0, 700.0 / max(log_fine, log_coarse))  # expm1 has no more
    if excess(high) < 0.0:
        return math.inf
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0.0 else (low, middle)
    return 0.5 * (low + high)


def estimate(sizes, values, orders=ORDERS_OF_SIZE):
    """`sizes` and `values` start with the coarsest; at least three."""
    pairs = sorted(zip(sizes, values))
    sizes, values = [size for size, _ in pairs], [value for _, value in pairs]
    differences = [coarse - fine for fine, coarse in zip(values, values[1:])]
    largest = max(abs(value) for value in values)
    if all(abs(difference) <= NEGLIGIBLE * largest for difference in differences):
        return Estimate("constant", extrapolated=values[0], index=0.0)
    if differences[0] == 0.0:
        return Estimate("order", math.inf)
    ratios = [coarse / fine for fine, coarse in zip(differences, differences[1:])]
    if ratios[0] < 0.0:
        return Estimate("oscillating")
    refinements = [coarse / fine for fine, coarse in zip(sizes, sizes[1:])]
    order = observed_order(ratios[0], refinements[0], refinements[1])
    if order == 0.0:
        return Estimate("diverging")
    if not orders[0] <= order <= orders[1]:
        return Estimate("order", order)
    if values[0] == 0.0:
        return Estimate("zero", order)
    if min(ratios) < 0.0:
        return Estimate("oscillating")
    indices = [index(values[k], differences[k], refinements[k], order) for k in range(len(differences))]
    for k in range(len(indices) - 1):
        if not RATIOS[0] <= indices[k + 1] / (refinements[k] ** order * indices[k]) <= RATIOS[1]:
            return Estimate("index", order)
    extrapolated = values[0] - differences[0] / math.expm1(order * math.log(refinements[0]))
    return Estimate("in range", order, extrapolated, indices[0])


def index(value, difference, refinement, order):
    """The grid convergence index, a share of the value."""
    if value == 0.0:
        return math.inf
    return SAFETY * abs(difference / value) / math.expm1(order * math.log(refinement))

"""Least squares over runs: where the misfit is smallest, and how well each key is known there.

`evaluate(points, purpose)` takes a list of arrays x (keys.py) and gives a list of residuals, (computed - measured) over
its scale, with None for a run that failed. The points of one call may run at the same time.
"""

import dataclasses
import math

import numpy
from scipy.optimize import least_squares
from scipy.special import ndtri, stdtrit

# Step of x for derivatives: it changes outputs by more than the noise that the tolerance of time steps leaves in them.
STEP = 1e-2
MOST_STEPS = 40
DECADES = (-2, -1, 1, 2)
# Where a key without a logarithm is tried again, as shares of its range.
SHARES = (0.1, 0.35, 0.65, 0.9)
# A fit whose sum of squares is above this share of that of a constant explains too little: other starts are tried.
POOR = 0.25
# Correlations from which on a key cannot be told apart: with one other key, and with all others together.
WITH_ONE, WITH_ALL = 0.99, 0.9999
# Singular values below this share of the largest are 0.
SINGULAR = 1e-6
NEAR_BOUND = 0.1 * STEP
# One-sided responses of an output that differ by more than this share of their mean have a kink between them. An output
# counts for a key if its response is above this share of that of all outputs.
KINK, COUNTS = 0.5, 0.1
# The misfit has a corner if it rises to both sides of the best value, by slopes above this share of a standard error.
CORNER = 0.5

# The search ends where a step would move the result by less than this share of its standard errors.
CLOSE = 1e-3
# Root mean square of the residuals below which points have no noise.
EXACT = 1e-6


class Converged(Exception):
    """Arguments: x, and the residuals there."""


class NoRun(Exception):
    """No run from which a search could start."""


@dataclasses.dataclass
class Search:
    x: numpy.ndarray
    residuals: numpy.ndarray
    converged: bool
    starts: int  # how many starts were searched from


def sum_of_squares(residuals):
    return math.inf if residuals is None else float(residuals @ residuals)


def is_close(matrix, residuals):
    """The criterion of Bates and Watts (1981): the part of the residuals that keys can lower, over the part that they cannot."""
    count, keys = matrix.shape
    if residuals @ residuals < EXACT**2 * count:
        return True
    if count <= keys:
        return False
    directions, values, _ = numpy.linalg.svd(matrix, full_matrices=False)
    lowered = directions[:, values > SINGULAR * max(values[0], 1e-300)].T @ residuals
    rest = max(residuals @ residuals - lowered @ lowered, 0.0)
    return (lowered @ lowered) / keys < CLOSE**2 * rest / (count - keys)


def moved(x, j, by):
    """The point with another value of one key."""
    point = numpy.array(x)
    point[j] += by
    return point


@dataclasses.dataclass
class Derivatives:
    matrix: numpy.ndarray
    failed: list  # numbers of keys whose runs failed on both sides: their column is 0
    halves: list  # of each key the derivatives to larger and to smaller values, None where one of the two is missing


def derivatives(evaluate, low, high, x):
    """The derivatives of the residuals.

    Differences are central, so that the last steps of the search lower the misfit by what they promise. They are
    one-sided at a bound, and where one of the two runs failed.
    """
    sides = [(j, sign) for j in range(len(x)) for sign in (1, -1) if low[j] <= x[j] + sign * STEP <= high[j]]
    base, *values = evaluate([numpy.array(x), *(moved(x, j, sign * STEP) for j, sign in sides)], "derivative")
    found = {side: value for side, value in zip(sides, values) if value is not None}
    columns = numpy.zeros((len(base), len(x)))
    failed, halves = [], [None] * len(x)
    for j in range(len(x)):
        above, below = found.get((j, 1)), found.get((j, -1))
        width = STEP * ((above is not None) + (below is not None))
        if not width:
            failed.append(j)
            continue
        columns[:, j] = ((base if above is None else above) - (base if below is None else below)) / width
        if width > 1.5 * STEP:
            halves[j] = ((above - base) / STEP, (base - below) / STEP)
    return Derivatives(columns, failed, halves)


@dataclasses.dataclass
class Kink:
    """Of a key whose larger and smaller values act in another way. `output`: the number of the output that shows it, and how much it
    responds to larger values and to smaller ones; None where only the misfit has a corner."""

    output: int = None
    above: float = 0.0
    below: float = 0.0


def output_with_kink(halves, parts):
    """The kink of the output that responds most among those with one, or None. `halves`: the responses to larger and to smaller
    values, over the change of the key. `parts`: the places of each output in the residuals."""
    above, below = halves
    size = 0.5 * (numpy.linalg.norm(above) + numpy.linalg.norm(below))
    kinks = []
    for output, at in enumerate(parts):
        up, down = numpy.linalg.norm(above[at]), numpy.linalg.norm(below[at])
        mean = 0.5 * (up + down)
        if mean > COUNTS * size and numpy.linalg.norm(above[at] - below[at]) > KINK * mean:
            kinks.append((mean, Kink(output, up, down)))
    return max(kinks, key=lambda kink: kink[0])[1] if kinks else None


def has_corner(halves, residuals, scale):
    """Whether the sum of squares rises to both sides at once; a smooth one has no slope where it is least. Half of the slope is
    taken over the standard error of a key that is fitted alone. `scale`: the size of a residual that is expected."""
    slopes = [(half @ residuals) / numpy.linalg.norm(half) for half in halves if numpy.any(half)]
    return len(slopes) == 2 and slopes[0] > CORNER * scale and slopes[1] < -CORNER * scale


def kink_of(halves, residuals, parts, scale):
    """The kink at the best value of a key, or None."""
    return output_with_kink(halves, parts) or (Kink() if has_corner(halves, residuals, scale) else None)


def mark_not_linear(evaluate, low, high, found, known, parts):
    """Compares the responses up to both ends of the 95 % intervals, and marks keys of which they differ. Intervals within the
    step of the derivatives are skipped, as kink_of has looked there."""
    half = known.quantile * known.error
    keys = [j for j, said in enumerate(known.said) if said == "known" and half[j] > STEP
            and low[j] <= found.x[j] - half[j] and found.x[j] + half[j] <= high[j]]
    points = [moved(found.x, j, sign * half[j]) for j in keys for sign in (1, -1)]
    values = evaluate(points, "interval") if points else []
    for j, above, below in zip(keys, values[::2], values[1::2]):
        if above is not None and below is not None:
            kink = output_with_kink([(above - found.residuals) / half[j], (found.residuals - below) / half[j]], parts)
            if kink:
                known.said[j], known.kinks[j] = "not linear", kink


def other_starts(logarithmic, low, high):
    """Starts in which one key is moved: by decades, or through its range."""
    starts = []
    for j, is_logarithmic in enumerate(logarithmic):
        if is_logarithmic:
            moves = [decades * math.log(10.0) for decades in DECADES]
        elif math.isfinite(high[j] - low[j]):
            moves = [low[j] + share * (high[j] - low[j]) for share in SHARES]
        else:
            moves = [-2.0, -0.5, 0.5, 2.0]
        starts += [moved(numpy.zeros(len(logarithmic)), j, move) for move in moves if low[j] <= move <= high[j]]
    return starts


def search(evaluate, logarithmic, low, high, of_constant):
    """`of_constant`: the sum of squares of the best constants. Throws NoRun."""

    def fun(x):
        (residuals,) = evaluate([x], "step")
        # SciPy takes a shorter step where residuals are not finite.
        return numpy.full(count, numpy.inf) if residuals is None else residuals

    def jac(x):
        matrix, (residuals,) = derivatives(evaluate, low, high, x).matrix, evaluate([x], "step")
        if is_close(matrix, residuals):
            raise Converged(x, residuals)
        return matrix

    def minimise(start):
        try:
            found = least_squares(fun, start, jac, bounds=(low, high), xtol=1e-5, ftol=1e-5, gtol=1e-10, max_nfev=MOST_STEPS)
            return Search(found.x, found.fun, found.status > 0, 1)
        except Converged as end:
            return Search(*end.args, True, 1)

    start = numpy.zeros(len(low))
    (residuals,) = evaluate([start], "start")
    count = 0 if residuals is None else len(residuals)
    best = minimise(start) if count else Search(start, None, False, 1)
    if sum_of_squares(best.residuals) > max(POOR * of_constant, 1e-12):
        starts = other_starts(logarithmic, low, high)
        found = evaluate(starts, "other start")
        least, place = min(zip(map(sum_of_squares, found), range(len(starts))), default=(math.inf, None))
        if least < sum_of_squares(best.residuals):
            count = len(found[place])
            best = min(best, minimise(starts[place]), key=lambda end: sum_of_squares(end.residuals))
            best.starts = 2
        elif best.residuals is None:
            raise NoRun
    return best


@dataclasses.dataclass
class Known:
    """How well the keys are known. `said[j]` is "known", says why `error[j]` is NaN, or is "not linear" where it is doubtful."""

    said: list
    error: numpy.ndarray  # standard error of x
    quantile: float  # half of the 95 % interval over the standard error
    correlations: numpy.ndarray  # NaN for keys that are not in them
    with_whom: list  # of a key that cannot be told apart: the number of the other key, None if it takes several
    misfit: float  # root mean square of residuals over degrees of freedom; 1 is expected with known deviations
    kinks: dict  # number of a key -> Kink, where said is "kink" or "not linear"


def uncertainty(found, residuals, negligible, has_deviations, at_bound=(), parts=None):
    """`found`: the derivatives. `negligible`: changes of residuals that are round-off. Keys at a bound count as given. `parts`:
    the places of each output in the residuals."""
    jacobian, kinks = found.matrix, {}
    count, keys = jacobian.shape
    parts = [numpy.arange(count)] if parts is None else parts
    said = ["known"] * keys
    for j in range(keys):
        if j in found.failed:
            said[j] = "runs failed"
        elif numpy.all(numpy.abs(jacobian[:, j]) * STEP <= negligible):
            said[j] = "no response"
        elif j in at_bound:
            said[j] = "at a bound"
    used = [j for j in range(keys) if said[j] == "known"]
    error, correlations, with_whom = numpy.full(keys, numpy.nan), numpy.full((keys, keys), numpy.nan), [None] * keys
    freedom = count - len(used)
    misfit = math.sqrt(sum_of_squares(residuals) / freedom) if freedom > 0 else math.nan
    scale = max(1.0, misfit) if has_deviations and freedom > 0 else 1.0 if has_deviations else misfit
    quantile = float(ndtri(0.975) if has_deviations else stdtrit(freedom, 0.975) if freedom > 0 else math.nan)
    if used:
        lengths = numpy.linalg.norm(jacobian[:, used], axis=0)
        _, values, directions = numpy.linalg.svd(jacobian[:, used] / lengths, full_matrices=False)
        if len(values) < len(used):  # fewer points than keys
            values, directions = numpy.zeros(len(used)), numpy.eye(len(used))
        # A floor for singular values gives keys that only act together a correlation of 1.
        values = numpy.maximum(values, SINGULAR * max(values[0], 1e-300))
        covariance = (directions.T / values**2) @ directions
        deviations = numpy.sqrt(numpy.diag(covariance))
        inner = covariance / numpy.outer(deviations, deviations)
        correlations[numpy.ix_(used, used)] = inner
        for k, j in enumerate(used):
            # The columns have length 1, so the diagonal is what the other keys inflate the variance by.
            with_all = math.sqrt(max(0.0, 1.0 - 1.0 / covariance[k, k]))
            with_one, other = max(((abs(inner[k, other]), used[other]) for other in range(len(used)) if other != k), default=(0.0, None))
            if with_one > WITH_ONE or with_all > WITH_ALL:
                said[j] = "not told apart"
                with_whom[j] = other if with_one > WITH_ONE else None
            elif not has_deviations and freedom <= 0:
                said[j] = "as many keys as points"
            elif found.halves[j] and (kink := kink_of(found.halves[j], residuals, parts, scale)):
                said[j], kinks[j] = "kink", kink
            else:
                error[j] = deviations[k] / lengths[k] * (1.0 if has_deviations else misfit)
    return Known(said, error, quantile, correlations, with_whom, misfit, kinks)

"""Bounds of a probability from counts: those of Clopper and Pearson (1934, Biometrika 26, 404), which are never too narrow."""

from scipy.stats import beta

SHARE = 0.95
DIGITS = 6  # of all that are written, so that tables do not depend on the version of SciPy


def bounds(failures, runs, share=SHARE):
    """The interval of probabilities with which so many failures are not unlikely."""
    tail = 0.5 * (1.0 - share)
    low = 0.0 if failures == 0 else beta.ppf(tail, failures, runs - failures + 1)
    high = 1.0 if failures == runs else beta.ppf(1.0 - tail, failures + 1, runs - failures)
    return float(f"{low:.{DIGITS}g}"), float(f"{high:.{DIGITS}g}")

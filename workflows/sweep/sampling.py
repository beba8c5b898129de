"""Distributions of a key, sampled with a seed: the same numbers on any machine.

Python's documentation promises the sequence of random.Random(text).random(). Each value is the inverse of the
distribution function at one of these numbers, and is rounded to ten digits, which hides differences between
mathematical libraries. Each key has a sequence of its own: further keys change no other column, and further runs keep
the ones before.

In a Latin hypercube the probability of each key is divided into as many equal strata as there are runs, and each
stratum has one run. Another number of runs has other strata, so further runs do not keep the ones before.
"""

import math
import random
import statistics

# Parameters that a distribution needs, and parameters that it may have. Mean and (standard)
# deviation are those of the quantity itself before it is cut off, for a lognormal distribution too.
PARAMETERS = {
    "normal": ({"mean", "deviation"}, {"min", "max"}),
    "lognormal": ({"mean", "deviation"}, {"min", "max"}),
    "uniform": ({"min", "max"}, set()),
    "integer": ({"min", "max"}, set()),  # whole numbers, such as seeds of random fields
}
DIGITS = 10


class Distribution:
    """Throws ValueError, which says what is expected, if parameters do not fit together."""

    def __init__(self, name, parameters):
        needed, possible = PARAMETERS[name]
        for parameter in sorted(needed - parameters.keys()):
            raise ValueError(f"a number for {parameter}, which {name} needs")
        for parameter in sorted(parameters.keys() - needed - possible):
            raise ValueError(f"no {parameter}, for which {name} has no use")
        self.name = name
        self.low = parameters.get("min", -math.inf)
        self.high = parameters.get("max", math.inf)
        if not self.low < self.high:
            raise ValueError("min below max")
        if name == "integer" and (self.low != int(self.low) or self.high != int(self.high)):
            raise ValueError("whole numbers as min and max")
        if name not in ("uniform", "integer"):
            self._set_normal(parameters["mean"], parameters["deviation"])
            if not self._share(self.low) < self._share(self.high):
                raise ValueError("min and max where values lie")

    def _set_normal(self, mean, deviation):
        """The normal distribution of the quantity, or of its logarithm."""
        if not deviation > 0.0:
            raise ValueError("a deviation above 0")
        if self.name == "lognormal":
            if not mean > 0.0:
                raise ValueError("a mean above 0")
            variance = math.log1p((deviation / mean) ** 2)
            mean, deviation = math.log(mean) - variance / 2.0, math.sqrt(variance)
        self.normal = statistics.NormalDist(mean, deviation)

    def _share(self, value):
        """Probability of less than `value`, before values are cut off."""
        if math.isinf(value):
            return 0.0 if value < 0.0 else 1.0
        if self.name == "lognormal":
            return self.normal.cdf(math.log(value)) if value > 0.0 else 0.0
        return self.normal.cdf(value)

    def quantile(self, share):
        """The value below which this share of all values lies, 0 < share < 1."""
        if self.name == "integer":
            return int(self.low) + math.floor(share * (self.high - self.low + 1.0))
        if self.name == "uniform":
            return self.low + share * (self.high - self.low)
        low = self._share(self.low)
        value = self.normal.inv_cdf(low + share * (self._share(self.high) - low))
        return min(max(math.exp(value) if self.name == "lognormal" else value, self.low), self.high)

    def sample(self, key, seed, count, latin_hypercube=False):
        """`count` values of a key, as texts."""
        generator = random.Random(f"{seed} {key}")
        # random() may be 0, where the inverse does not exist.
        shares = [generator.random() or 2.0**-54 for _ in range(count)]
        if latin_hypercube:
            shares = [(stratum + share) / count for stratum, share in zip(strata(key, seed, count), shares)]
        digits = "d" if self.name == "integer" else f".{DIGITS}g"
        return [format(self.quantile(share), digits) for share in shares]


def strata(key, seed, count):
    """The stratum of each run: a permutation, from random() alone, as Python does not promise what shuffle() gives."""
    generator = random.Random(f"{seed} {key} strata")
    order = [generator.random() for _ in range(count)]
    return sorted(range(count), key=order.__getitem__)

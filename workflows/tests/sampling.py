#!/usr/bin/python3
"""Are the distributions of a sweep the exact ones, and the same ones everywhere? Prints what fails."""

import math
import pathlib
import statistics
import tempfile

from scipy import stats

from expectations import answer, expect, expect_near, finish
from runs import read_runs
from sampling import Distribution

# The square of deviation over mean is 1/4, so the variance of the logarithm is log(1 + 1/4), and the median 2 / sqrt(1 + 1/4).
LOGNORMAL = stats.lognorm(math.sqrt(math.log(1.25)), scale=2.0 / math.sqrt(1.25))
# A distribution, and SciPy's before values are cut off.
CASES = [
    ("normal", {"mean": 0.3, "deviation": 0.02}, stats.norm(0.3, 0.02)),
    ("normal", {"mean": 0.3, "deviation": 0.1, "min": 0.25, "max": 0.5}, stats.norm(0.3, 0.1)),
    ("lognormal", {"mean": 2.0, "deviation": 1.0}, LOGNORMAL),
    ("lognormal", {"mean": 2.0, "deviation": 1.0, "max": 3.0}, LOGNORMAL),
    ("uniform", {"min": -1.0, "max": 3.0}, stats.uniform(-1.0, 4.0)),
]


def check_integers():
    """All whole numbers, ends included, equally often; texts without a point."""
    texts = Distribution("integer", {"min": 3.0, "max": 6.0}).sample("soil.a.field.seed", 1, 4000)
    counts = {text: texts.count(text) for text in sorted(set(texts))}
    expect("whole numbers drawn", ["3", "4", "5", "6"], list(counts))
    for text, count in counts.items():
        # Four standard errors of a count with the probability 1/4.
        expect_near(f"draws of {text}", 1000, count, 4.0 * math.sqrt(4000 * 0.25 * 0.75))
    large = Distribution("integer", {"min": 0.0, "max": 2147483647.0}).sample("soil.a.field.seed", 1, 50)
    expect("large whole numbers", True, all(text.isdigit() for text in large))


def check_distributions():
    for case in CASES:
        expect_distribution(*case)


def expect_distribution(name, parameters, exact):
    what = f"{name} {parameters}"
    distribution = Distribution(name, parameters)
    low, high = parameters.get("min"), parameters.get("max")
    first, last = 0.0 if low is None else exact.cdf(low), 1.0 if high is None else exact.cdf(high)
    share_below = lambda value: (exact.cdf(value) - first) / (last - first)
    for share in (0.001, 0.1, 0.25, 0.5, 0.9, 0.999):
        expect_near(f"{what}: share below the quantile of {share}", share, share_below(distribution.quantile(share)), 1e-6)
    mean = exact.expect(lb=low, ub=high, conditional=True)
    deviation = math.sqrt(exact.expect(lambda x: (x - mean) ** 2, lb=low, ub=high, conditional=True))
    count = 20000
    values = [float(text) for text in distribution.sample("soil.a.porosity", 1, count)]
    # The tolerance is four standard errors; the seed is always the same.
    expect_near(f"{what}: mean of a sample", mean, statistics.fmean(values), 4.0 * deviation / math.sqrt(count))
    expect_near(f"{what}: deviation of a sample", deviation, statistics.pstdev(values), 0.05 * deviation)
    values.sort()
    for share in (0.1, 0.5, 0.9):
        error = 4.0 * math.sqrt(share * (1.0 - share) / count)
        expect_near(f"{what}: quantile {share} of a sample", share, share_below(values[int(share * count)]), error)


def check_seeds():
    conductivity = Distribution("lognormal", {"mean": 2e-2, "deviation": 1e-2})
    porosity = Distribution("normal", {"mean": 0.3, "deviation": 0.02})
    pinned = conductivity.sample("soil.a.conductivity", 1, 3)
    expect("seed 1", PINNED_LOGNORMAL, pinned)
    expect("seed 1, normal", PINNED_NORMAL, porosity.sample("soil.a.porosity", 1, 3))
    expect("more runs keep the first", pinned, conductivity.sample("soil.a.conductivity", 1, 9)[:3])
    for other in (conductivity.sample("soil.a.conductivity", 2, 3), conductivity.sample("soil.b.conductivity", 1, 3)):
        expect("another seed or key has other values", True, other != pinned)


def check_latin_hypercube():
    uniform = Distribution("uniform", {"min": 0.0, "max": 1.0})
    for count in (1, 7, 100):
        values = [float(text) for text in uniform.sample("soil.a.porosity", 1, count, True)]
        expect(f"each of {count} strata has one run", list(range(count)), sorted(int(value * count) for value in values))
    cut = Distribution("lognormal", {"mean": 2.0, "deviation": 1.0, "min": 1.0, "max": 3.0})
    edges = [cut.quantile(k / 50) for k in range(1, 50)]
    values = sorted(float(text) for text in cut.sample("a", 3, 50, True))
    expect("strata of a distribution that is cut off", list(range(50)), [sum(edge <= value for edge in edges) for value in values])
    first, second = (uniform.sample(key, 1, 100, True) for key in ("a", "b"))
    ranks = [[sorted(values).index(value) for value in values] for values in (first, second)]
    expect("keys are in orders of their own", True, abs(statistics.correlation(*ranks)) < 0.3)
    expect("seed 1, latin hypercube", PINNED_LATIN_HYPERCUBE, uniform.sample("a", 1, 3, True))


PINNED_LATIN_HYPERCUBE = ["0.6128736991", "0.7781635443", "0.2918221388"]
PINNED_LOGNORMAL = ["0.007637445206", "0.0253481138", "0.03726107624"]
PINNED_NORMAL = ["0.2829463443", "0.2874452831", "0.3041719825"]
HEADER = "key,distribution,mean,deviation,min,max"
SAMPLED = f"runs,2\nseed,1\n{HEADER}\n"

# Texts of a table, and the messages about them; TABLE stands for its path.
WRONG = [
    ("", "TABLE: got no line; expected a line of keys and a line for each run"),
    ("a,b\n", "TABLE: got no run; expected a row for each run"),
    ("a;b\n1;2\n", 'TABLE:1: got "a;b"; expected commas between columns'),
    ("a,a\n1,2\n", 'TABLE:1: got "a" twice; expected each key once'),
    ("a,\n1,2\n", 'TABLE:1: got ""; expected a key of the scene'),
    ("a,b=c\n1,2\n", 'TABLE:1: got "b=c"; expected a key of the scene'),
    ("a,b\n1\n1,2,3\n", "TABLE:2: got 1 cells; expected 2\nTABLE:3: got 3 cells; expected 2"),
    ('a\n"1\n2"\n', "TABLE:3: a: got a value of several lines; expected one of one line"),
    ("a\n" + "1\n" * 10000, "TABLE: got 10000 runs; expected at most 9999"),
    ("sampling,latin-hypercube\n", f"TABLE: got no line of columns; expected {HEADER}"),
    (SAMPLED.replace("seed,1\n", "seed,1\nsampling,latin\n") + "a,uniform,,,1,2\n",
     'TABLE:3: sampling: got "latin"; expected "independent" or "latin-hypercube"'),
    (SAMPLED.replace("seed,1\n", "seed,1\nsampeling,latin-hypercube\n") + "a,uniform,,,1,2\n",
     'TABLE:3: got "sampeling"; expected runs, seed or sampling; did you mean sampling?'),
    ("runs,2\nseed,1\n", f"TABLE: got no line of columns; expected {HEADER}"),
    ("runs,2\nseed,1\nkey,distribution\n", f"TABLE:3: got key,distribution; expected {HEADER}"),
    (SAMPLED, "TABLE: got no distribution; expected a row for each key"),
    (SAMPLED.replace("seed,1\n", "") + "a,uniform,,,1,2\n",
     'TABLE: seed: got no such line; expected "seed,NUMBER" above the line of columns'),
    (SAMPLED.replace("runs,2", "runs,0") + "a,uniform,,,1,2\n", 'TABLE:1: runs: got "0"; expected a whole number, at least 1'),
    (SAMPLED.replace("runs,2", "runs,20000") + "a,uniform,,,1,2\n", "TABLE: got 20000 runs; expected at most 9999"),
    (SAMPLED + "a,gaussian,1,2,,\nb,lognormall,1,2,,\n",
     'TABLE:4: a: distribution: got "gaussian"; expected "normal", "lognormal" or "uniform"\n'
     'TABLE:5: b: distribution: got "lognormall"; expected "normal", "lognormal" or "uniform"; did you mean lognormal?'),
    (SAMPLED + "a,normal,x,2,,\n", 'TABLE:4: a: mean: got "x"; expected a number'),
    (SAMPLED + "a,normal,nan,2,,\n", 'TABLE:4: a: mean: got "nan"; expected a number'),
    (SAMPLED + "a,normal,1,,,\n", "TABLE:4: a: got 1,,,; expected a number for deviation, which normal needs"),
    (SAMPLED + "a,uniform,1,,1,2\n", "TABLE:4: a: got 1,,1,2; expected no mean, for which uniform has no use"),
    (SAMPLED + "a,uniform,,,2,1\n", "TABLE:4: a: got ,,2,1; expected min below max"),
    (SAMPLED + "a,normal,1,0,,\n", "TABLE:4: a: got 1,0,,; expected a deviation above 0"),
    (SAMPLED + "a,lognormal,-1,1,,\n", "TABLE:4: a: got -1,1,,; expected a mean above 0"),
    (SAMPLED + "a,normal,0,1,50,51\n", "TABLE:4: a: got 0,1,50,51; expected min and max where values lie"),
    (SAMPLED + "a,uniform,,,1,2\na,uniform,,,1,2\n", 'TABLE:5: got "a" twice; expected each key once'),
    (SAMPLED + "a,uniform,,,1,2,3\n", f"TABLE:4: got 7 cells; expected {HEADER}"),
]


def check_tables():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "a table.csv"

        def said_of(text):
            path.write_text(text, encoding="utf-8")
            return answer(read_runs, path)

        for text, message in WRONG:
            expect(repr(text[:80]), message.replace("TABLE", str(path)), said_of(text))
        expect("no file", f"{folder}/none.csv: No such file or directory", answer(read_runs, f"{folder}/none.csv"))
        expect("comments, empty cells, a byte order mark", (["a", "b"], [["1", ""], ["[[0, 1]]", "x"]]),
               said_of('\ufeff# of keys\na, b\n1,\n\n"[[0, 1]]",x\n'))
        keys, runs = said_of(SAMPLED + "a,uniform,,,1,2\nb,normal,0,1,,\n")
        latin = Distribution("uniform", {"min": 1.0, "max": 2.0}).sample("a", 1, 2, True)
        expect("sampled as a latin hypercube", (["a"], [[text] for text in latin]),
               said_of(SAMPLED.replace("seed,1\n", "seed,1\nsampling,latin-hypercube\n") + "a,uniform,,,1,2\n"))
        expect("sampled: keys", ["a", "b"], keys)
        expect("sampled: runs", Distribution("uniform", {"min": 1.0, "max": 2.0}).sample("a", 1, 2), [run[0] for run in runs])


finish("distributions, seeds and tables of a sweep", globals())

"""The table SWEEP of a sweep: the keys that it changes, and their values in each run.

Either columns are keys and rows are runs; an empty cell leaves the key as the scene has it. Or runs are sampled:

    runs,100
    seed,1
    sampling,latin-hypercube
    key,distribution,mean,deviation,min,max
    soil.foundation.porosity,normal,0.3,0.02,0.2,0.4

The line `sampling` may be left out: then runs are independent of each other. Empty lines, and lines that start with #,
are left out.
"""

import csv
import re

from common import InputError, number_of, problem, wrong
from sampling import PARAMETERS, Distribution

MOST_RUNS = 9999
SETTINGS = ["runs", "seed", "sampling"]
SAMPLINGS = ["independent", "latin-hypercube"]
SAMPLED = ["key", "distribution", "mean", "deviation", "min", "max"]
KEY = re.compile(r'[A-Za-z_"][^=\n]*')


def lines_of(path, expected="a line of keys and a line for each run"):
    """Pairs of line number and cells."""
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file, strict=True)
            rows = [(reader.line_num, [cell.strip() for cell in row]) for row in reader]
    except OSError as error:
        raise InputError([f"{path}: {error.strerror}"]) from None
    except (csv.Error, UnicodeDecodeError) as error:
        raise InputError([f"{path}: is no table: {error}"]) from None
    rows = [(line, row) for line, row in rows if any(row) and not row[0].startswith("#")]
    if not rows:
        raise wrong(path, "", "no line", expected)
    return rows


def check_keys(path, rows):
    """`rows`: pairs of line number and key."""
    problems = []
    known = []
    for line, key in rows:
        if not KEY.fullmatch(key):
            problems.append(problem(f"{path}:{line}", "", f'"{key}"', "a key of the scene"))
        elif key in known:
            problems.append(problem(f"{path}:{line}", "", f'"{key}" twice', "each key once"))
        known.append(key)
    return problems


def listed_runs(path, rows):
    line, keys = rows[0]
    if len(keys) == 1 and ";" in keys[0]:
        raise wrong(f"{path}:{line}", "", f'"{keys[0]}"', "commas between columns")
    problems = check_keys(path, [(line, key) for key in keys])
    if len(rows) == 1:
        problems.append(problem(path, "", "no run", "a row for each run"))
    for line, cells in rows[1:]:
        if len(cells) != len(keys):
            problems.append(problem(f"{path}:{line}", "", f"{len(cells)} cells", str(len(keys))))
        for key, cell in zip(keys, cells):
            if "\n" in cell:
                problems.append(problem(f"{path}:{line}", key, "a value of several lines", "one of one line"))
    if problems:
        raise InputError(problems)
    return keys, [cells for line, cells in rows[1:]]


def setting(name, rows):
    """Number and text of the line `name,TEXT`."""
    return next(((line, ",".join(cells[1:]).rstrip(",")) for line, cells in rows if cells[0] == name), (0, ""))


def read_setting(path, name, least, rows):
    """The whole number of the line `name,NUMBER`."""
    line, found = setting(name, rows)
    if not line:
        raise wrong(path, name, "no such line", f'"{name},NUMBER" above the line of columns')
    if not re.fullmatch(r"\d+", found) or int(found) < least:
        raise wrong(f"{path}:{line}", name, f'"{found}"', f"a whole number, at least {least}")
    return int(found)


def read_sampling(path, rows):
    line, found = setting("sampling", rows)
    if line and found not in SAMPLINGS:
        raise wrong(f"{path}:{line}", "sampling", f'"{found}"', '"independent" or "latin-hypercube"', SAMPLINGS)
    return found or SAMPLINGS[0]


def read_distribution(path, line, cells):
    key, name = cells[0], cells[1]
    if name not in PARAMETERS:
        raise wrong(f"{path}:{line}", f"{key}: distribution", f'"{name}"', '"normal", "lognormal" or "uniform"', PARAMETERS)
    parameters = {}
    for parameter, cell in zip(SAMPLED[2:], cells[2:]):
        if not cell:
            continue
        parameters[parameter] = number_of(cell)
        if parameters[parameter] is None:
            raise wrong(f"{path}:{line}", f"{key}: {parameter}", f'"{cell}"', "a number")
    try:
        return Distribution(name, parameters)
    except ValueError as error:
        raise wrong(f"{path}:{line}", key, ",".join(cells[2:]), str(error)) from None


def sampled_runs(path, rows, start):
    count = read_setting(path, "runs", 1, rows[:start])
    seed = read_setting(path, "seed", 0, rows[:start])
    latin_hypercube = read_sampling(path, rows[:start]) == "latin-hypercube"
    problems = [problem(f"{path}:{line}", "", f'"{cells[0]}"', "runs, seed or sampling", SETTINGS)
                for line, cells in rows[:start] if cells[0] not in SETTINGS]
    problems += check_keys(path, [(line, cells[0]) for line, cells in rows[start + 1 :]])
    if len(rows) == start + 1:
        problems.append(problem(path, "", "no distribution", "a row for each key"))
    columns = []
    for line, cells in rows[start + 1 :]:
        try:
            if len(cells) > len(SAMPLED) or len(cells) < 2:
                raise wrong(f"{path}:{line}", "", f"{len(cells)} cells", ",".join(SAMPLED))
            columns.append((cells[0], read_distribution(path, line, cells)))
        except InputError as error:
            problems.append(str(error))
    if problems:
        raise InputError(problems)
    if count > MOST_RUNS:
        return [key for key, _ in columns], [[]] * count
    samples = [distribution.sample(key, seed, count, latin_hypercube) for key, distribution in columns]
    return [key for key, _ in columns], [list(cells) for cells in zip(*samples)]


def read_runs(path):
    """Keys, and a list of their values for each run. Throws InputError."""
    rows = lines_of(path)
    start = next((i for i, (_, cells) in enumerate(rows) if cells[0] == "key"), None)
    if start is None and {cells[0] for _, cells in rows} & set(SETTINGS):
        raise wrong(path, "", "no line of columns", ",".join(SAMPLED))
    if start is not None and rows[start][1] != SAMPLED:
        raise wrong(f"{path}:{rows[start][0]}", "", ",".join(rows[start][1]), ",".join(SAMPLED))
    keys, runs = listed_runs(path, rows) if start is None else sampled_runs(path, rows, start)
    if len(runs) > MOST_RUNS:
        raise wrong(path, "", f"{len(runs)} runs", f"at most {MOST_RUNS}")
    return keys, runs

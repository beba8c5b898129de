"""What the scripts of all studies share: tables, run.json, documents, programs, and how wrong input is said."""

import csv
import difflib
import io
import json
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import time
import tomllib

WORKFLOWS = pathlib.Path(__file__).resolve().parent

# --- Tables ------------------------------------------------------------------------------------------------


def csv_text(rows):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def read_csv(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


def read_rows(path):
    """Rows as dictionaries; none where there is no such file. Names of columns without their units."""
    header, *rows = (read_csv(path) if os.path.isfile(path) else []) or [[]]
    names = [re.sub(r"\s+(\[[^\[\]]*\]|\([^()]*\))$", "", name) for name in header]
    return [dict(zip(names, row)) for row in rows if row and not row[0].startswith("#")]


def read(path):
    return path.read_text(encoding="utf-8", errors="replace")


def write(path, text):
    """Writes a file, which is never there in part."""
    pending = path.with_name(path.name + ".new")
    pending.write_text(text, encoding="utf-8")
    pending.replace(path)


def write_changed(path, text):
    """Writes a file, unless it has this text already: then it keeps its time."""
    if not path.is_file() or read(path) != text:
        write(path, text)


def last_rows(path):
    """The rows of the last time of a table."""
    rows = read_rows(path)
    return [row for row in rows if row["t"] == rows[-1]["t"]]


def number_of(text, infinite=False):
    """A number, or None; a finite one, unless infinity has a meaning."""
    try:
        value = float(text)
    except (TypeError, ValueError):
        return None
    return value if math.isfinite(value) or infinite and not math.isnan(value) else None


def is_number(value):
    """Whether a value of a scene is a finite number."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def cell(value, digits=10):
    return "" if value is None or value != value else f"{value:.{digits}g}"


def median(values):
    """The lower one of two in the middle."""
    return sorted(values, key=float)[(len(values) - 1) // 2]


def power(pairs):
    """The exponent b of y = a x^b, by least squares; None of fewer than two pairs."""
    logarithms = [[math.log(value) for value in values] for values in zip(*pairs)]
    return statistics.linear_regression(*logarithms).slope if len(pairs) > 1 else None


# --- Documents ---------------------------------------------------------------------------------------------


def markdown(header, rows, left=(0,)):
    """A table as text; the columns `left` are words, the others numbers."""
    rule = "|" + "|".join("---" if column in left else "---:" for column in range(len(header))) + "|"
    line = lambda row: "|" + "".join(f" {text} |" for text in row)
    return "\n".join([line(header), rule, *map(line, rows)]) + "\n"


def put_between(name, document, text):
    """Puts a text between <!-- NAME: ... --> and <!-- end of NAME --> of a document."""
    path = pathlib.Path(document)
    marks = re.compile(rf"(<!-- {name}: [^\n]*\n).*?(^[^\n]*<!-- end of {name} -->)", re.S | re.M)
    write_changed(path, marks.sub(lambda found: found[1] + text + found[2], path.read_text(encoding="utf-8")))


# --- Programs and their results ----------------------------------------------------------------------------


def call(*command, ok=(0,), **options):
    """Calls a program. The script ends where its exit code is not `ok`."""
    ended = subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)
    if ended.returncode not in ok:
        sys.exit(f"{' '.join(map(str, command))}: exit code {ended.returncode}\n{ended.stdout}{ended.stderr}")
    return ended


def consult(*command, **options):
    """Calls a program. Throws InputError with what it says if it refuses its input, and NotDone where it fails."""
    try:
        ended = subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)
    except OSError as error:
        raise NotDone([f"{command[0]}: cannot be run: {error.strerror}"]) from None
    if ended.returncode == 2:
        raise InputError([ended.stderr.strip()])
    if ended.returncode:
        raise NotDone([f"{command[0]} ended with exit code {ended.returncode}", ended.stderr.strip()])
    return ended


def timed(*command, **options):
    """Wall time of a program, and what `call` returns."""
    begin = time.perf_counter()
    ended = call(*command, **options)
    return time.perf_counter() - begin, ended


def empty_folder(folder):
    """Makes a folder, without what an earlier call left in it."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def set_options(changes):
    """KEY=VALUE as options of the mesher."""
    return [part for change in changes for part in ("--set", change)]


def run_json(results):
    """What run.json says, with numbers as the texts that are there."""
    return json.loads((pathlib.Path(results) / "run.json").read_text(encoding="utf-8"), parse_float=str, parse_int=str)


def passes(run, pattern=""):
    """The passes of a run whose names begin with a pattern."""
    return [found for found in run["passes"] if re.match(pattern, found["name"])]


def pass_seconds(run, pattern=""):
    return f"{sum(float(found['seconds']) for found in passes(run, pattern)):.6g}"


def draw_curves(stem, programs, *arguments):
    """`suffuse-post figure curves` as STEM.png and STEM.svg. Returns what is said where it fails."""
    for suffix in ("png", "svg"):
        ended = subprocess.run([programs / "suffuse-post", "figure", "curves", *arguments, "-o", f"{stem}.{suffix}"], capture_output=True, text=True)
        if ended.returncode:
            return ended.stderr.strip()
    return ""


def file_name(text):
    return re.sub(r"[^\w.-]+", "-", text).strip("-")


UNITS = {"s": 1, "min": 60, "h": 3600, "kB": 1e3, "MB": 1e6, "GB": 1e9}


def estimate_of(said):
    """The estimate in what `suffuse-solver --explain` says, as texts: steps, seconds, bytes of memory, bytes on disk, and
    whether it comes from a trial of the whole run or of a part."""
    if re.search("^estimate: none, ", said, re.M):
        return ["", "", "", "", "none"]
    steps, parts = re.search(r"^estimate: (\d+) steps, (.*)", said, re.M).groups()
    amounts = [re.match(r"(\S+) (\w+)(.*)", part).groups() for part in parts.split(", ")]
    found = {"memory" if " of memory" in rest else "time" if unit in ("s", "min", "h") else "disk": float(number) * UNITS[unit]
             for number, unit, rest in amounts if unit in UNITS}
    rests = re.search("^estimate: from a trial of the (.*)", said, re.M)[1]
    return [steps, *(f"{found[name]:.3g}" for name in ("time", "memory", "disk")), "whole" if "whole run" in rests else "part"]


# --- Input -------------------------------------------------------------------------------------------------


class InputError(Exception):
    """Problems of the input, all at once: a line each."""

    def __init__(self, problems):
        super().__init__("\n".join(problems))


def problem(where, key, found, expected, known=()):
    """A line like `FILE:LINE: key: got FOUND; expected EXPECTED; did you mean NAME?`. `known`: what may be meant."""
    close = difflib.get_close_matches(found.strip('"'), known, 1)
    parts = [str(where), key] if key else [str(where)]
    return ": ".join(parts + [f"got {found}; expected {expected}"]) + (f"; did you mean {close[0]}?" if close else "")


def wrong(*arguments):
    """One problem, to be raised."""
    return InputError([problem(*arguments)])


def read_scene(path):
    try:
        return tomllib.loads(pathlib.Path(path).read_text(encoding="utf-8-sig"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError([f"{path}: cannot be read: {error}"]) from None


def find_file(variable):
    """The path of the file that a variable of make names, relative to the folder where make was called, or to workflows/."""
    value, called_from = os.environ.get(variable, ""), os.environ["CALLED_FROM"]
    if not value:
        raise wrong(variable, "", "nothing", f"a file: make -C workflows TARGET {variable}=FILE")
    for folder in (pathlib.Path(called_from), WORKFLOWS):
        if (folder / value).is_file():
            return (folder / value).resolve()
    raise InputError([f"{variable}: got '{value}'; there is no such file, seen from {called_from}"])


def folder_of(target, file):
    """The folder OUT/TARGET/NAME; without NAME= it is called like the file."""
    return pathlib.Path(os.environ["OUT_FOLDER"]) / target / (os.environ.get("NAME") or file.stem)


def programs_of():
    return pathlib.Path(os.environ["PROGRAMS"]).resolve()


class NotDone(InputError):
    """Runs that were stopped, or have not reached their end: the next call goes on with them."""


def end_with(name, work):
    """Calls `work`, and ends the script with the exit code that it returns; 2 for wrong input, 1 for runs that are not done."""
    try:
        sys.exit(work())
    except InputError as error:
        print("\n".join(name + line for line in str(error).splitlines()), file=sys.stderr)
        sys.exit(1 if isinstance(error, NotDone) else 2)


if __name__ == "__main__":  # common.py NAME DOCUMENT.md puts its input between marks
    put_between(sys.argv[1], sys.argv[2], sys.stdin.read())

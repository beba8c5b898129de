#!/usr/bin/python3
"""Numbers of the README and of tutorials against runs, and check_documents.py against a folder with mistakes.

    documents.py PROGRAMS

numbers.csv has a row for each number: the page, the words in which it says the number, where the number comes from, its
value, and how far a run may be from it. Sources are

    weir history COLUMN         the last row of the table of the example weir; `rows` is the number of rows
    weir check MECHANISM        the least factor of a mechanism in `suffuse-post check`
    levee check PLACE           the least safety against heave in all soil or at a boundary of the example levee
    adapt SCENE COLUMN          the last mesh of `make adapt`
    test FILE: TEXT             a test that asserts the number with these words; the test itself runs elsewhere
    page FILE: TEXT             a page whose tables a target measures, in these words; a target of hours makes them
"""
import re
import sys
import tempfile
from functools import cache
from pathlib import Path

from expectations import workflows
from common import call, read_rows

ROOT = workflows.parent
PROGRAMS = (workflows / sys.argv[1]).resolve()
SCRATCH = tempfile.TemporaryDirectory()
WORK = Path(SCRATCH.name)
EXAMPLES = {"weir": "weir/weir.toml", "levee": "levee/flood.toml"}


@cache
def results(example):
    """The results of an example, as a run of the scene makes them."""
    stem = WORK / example
    call(PROGRAMS / "suffuse-mesher", workflows / "examples" / EXAMPLES[example], "-o", f"{stem}.case.h5")
    call(PROGRAMS / "suffuse-solver", f"{stem}.case.h5", "-o", f"{stem}.results", "--quiet")
    return f"{stem}.results"


@cache
def checks(example):
    return call(PROGRAMS / "suffuse-post", "check", results(example)).stdout


@cache
def last_mesh(scene):
    """The last row of the table of an adapted mesh."""
    out = WORK / "adapted"
    call("make", "-s", "-C", workflows, "adapt", f"SCENE=adapt/{scene}.toml", f"BIN={PROGRAMS}", f"OUT={out}")
    return read_rows(out / "adapt" / f"{scene}.adapt.csv")[-1]


def found(source):
    """The number of a source, by a run."""
    what, kind, name = source.split(" ", 2)
    if what == "adapt":
        return float(last_mesh(kind)[name])
    if kind == "history":
        rows = read_rows(f"{results(what)}/history.csv")
        return len(rows) if name == "rows" else float(rows[-1][name])
    number = r"^%s +" % re.escape(name) if what == "levee" else r"^%s +\S+ +" % re.escape(name)
    return float(re.search(number + r"([0-9.eE+-]+)", checks(what), re.M)[1])


def problem_of(row):
    """What is wrong with a row of numbers.csv, or nothing."""
    page, sentence, source = row["page"], row["sentence"], row["source"]
    words = lambda text: re.sub(r"\s+", " ", text)
    if words(sentence) not in words((ROOT / page).read_text()):
        return f"{page}: does not say '{sentence}'; expected that, or another row in numbers.csv"
    if source.startswith(("test ", "page ")):
        file, text = source[5:].split(": ", 1)
        return "" if text in (ROOT / file).read_text() else f"{page}: '{sentence}': {file} does not say '{text}'"
    value, within, number = float(row["value"]), float(row["within"]), found(source)
    return "" if abs(number - value) <= within else f"{page}: '{sentence}': the run gives {number:g} ({source})"


def mistakes_are_found():
    """Problems of check_documents.py with a folder that has one of each kind of mistake."""
    root = WORK / "documents"
    (root / "docs").mkdir(parents=True)
    (root / "README.md").write_text("# A\n## One `two`, *three*\n[a](#one-two-three) [b](#four) [c](docs/b.md) [d](docs/b.md#x-1)\n"
                                    "[e](docs/b.md#x-2) `[f](g)`\n\n    [h](i)\n" + "word " * 600)
    (root / "docs/b.md").write_text("# X\n## X\n![y](z.png) | word |\n<!-- t: by a target -->\n| 1 |\n<!-- end of t -->\n")
    (root / "docs/README.md").write_text("[r](../README.md)\n")
    expected = ["README.md:3: #four has no such heading", "README.md:4: docs/b.md#x-2 has no such heading",
                "docs/b.md:3: there is no z.png", "README.md: has 613 words; expected at most 600",
                "docs/b.md: is not in docs/README.md",
                "check_documents: 3 pages, 5 words written below docs/ (23 by wc -w), 5 problems"]
    lines = call(workflows / "check_documents.py", root, ok=(1,)).stdout.splitlines()
    return [] if lines == expected else [f"check_documents.py: got {lines}; expected {expected}"]


def main():
    rows = read_rows(workflows / "tests/numbers.csv")
    problems = [*mistakes_are_found(), *filter(None, map(problem_of, rows))]
    print("\n".join(problems + [f"documents: {len(rows)} numbers, {len(problems)} problems"]))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

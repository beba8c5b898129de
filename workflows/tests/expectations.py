"""What the tests in Python share: they find the modules of all studies, say what fails, and count it."""

import pathlib
import sys

workflows = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(workflows / folder) for folder in ("", "accuracy", "convergence", "fit", "level", "sweep")]
from common import InputError

failures = 0


def expect(what, expected, found):
    global failures
    if expected != found:
        print(f"FAILED: {what}: expected {expected!r}, found {found!r}")
        failures += 1


def expect_near(what, expected, found, tolerance):
    if not abs(found - expected) <= tolerance:
        expect(what, f"{expected} +- {tolerance}", found)


def answer(function, *arguments):
    """What a function returns, or the text of what it says of wrong input."""
    try:
        return function(*arguments)
    except InputError as error:
        return str(error)


def finish(what, names):
    """Ends a test: calls each check_... among its names, and says what holds or leaves with exit code 1."""
    for name, check in list(names.items()):
        if name.startswith("check_"):
            check()
    if not failures:
        print(f"ok: {what}")
    sys.exit(failures > 0)

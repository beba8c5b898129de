"""What the tests in Python expect; counts what fails."""

import sys

failures = 0


def expect(what, expected, found):
    global failures
    if expected != found:
        print(f"FAILED: {what}: expected {expected!r}, found {found!r}")
        failures += 1


def expect_near(what, expected, found, tolerance):
    if not abs(found - expected) <= tolerance:
        expect(what, f"{expected} +- {tolerance}", found)


def finish(what):
    """Ends the test: says what holds, or leaves with exit code 1."""
    if not failures:
        print(f"ok: {what}")
    sys.exit(failures > 0)

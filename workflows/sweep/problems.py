"""What is wrong with the input of a sweep, said as the programs say it."""

import difflib


class InputError(Exception):
    """Problems of the input, all at once: a line each."""

    def __init__(self, problems):
        super().__init__("\n".join(problems))


def problem(where, key, found, expected, known=()):
    """A line like `FILE:LINE: key: got FOUND; expected EXPECTED; did you mean NAME?`. `known`: what may be meant."""
    close = difflib.get_close_matches(found.strip('"'), known, 1)
    parts = [str(where), key] if key else [str(where)]
    return ": ".join(parts + [f"got {found}; expected {expected}"]) + (f"; did you mean {close[0]}?" if close else "")

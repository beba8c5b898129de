#!/usr/bin/python3
"""How many tests ran in the programs whose output ctest keeps: count_tests.py LastTest.log. Exit code 1 if a program ended before
its last test although ctest took it for passed."""

import re
import sys

log = open(sys.argv[1], encoding="utf-8", errors="replace").read()
begun, ran, skipped, passed = ([int(count) for count in re.findall(pattern, log, re.M)] for pattern in (
    r"^\[==========\] Running (\d+) tests? from", r"^\[==========\] (\d+) tests? from .* ran\.",
    r"^\[  SKIPPED \] (\d+) tests?, listed below", r"^\[  PASSED  \] (\d+) tests?\.$"))
missing = sum(begun) - sum(passed) - sum(skipped)
print(f"{sum(begun)} tests in {len(ran)} programs started: {sum(passed)} passed, {sum(skipped)} skipped, {missing} not")
sys.exit(missing > 0)

# How many tests ran in the programs whose output ctest keeps: awk -f count_tests.awk LastTest.log. Exit code 1 if a
# program ended before its last test although ctest took it for passed.
/^\[==========\] Running [0-9]+ tests? from/ { begun += $3 }
/^\[==========\] [0-9]+ tests? from .* ran\./ { ran += $2; ++suites }
/^\[  SKIPPED \] [0-9]+ tests?, listed below/ { skipped += $4 }
/^\[  PASSED  \] [0-9]+ tests?\.$/ { passed += $4 }
END {
  printf "%d tests in %d programs started: %d passed, %d skipped, %d not\n", begun, suites, passed, skipped, begun - passed - skipped
  exit begun > passed + skipped
}

#!/usr/bin/env bash
# The movement of the soil in the seconds after it first fails, as a figure: fall.sh POST RESULTS
# FIGURE.
set -eu -o pipefail
failed=$(awk -F, '
  NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
  $column["failure_time"] > 0 && !failed { failed = int($column["failure_time"]) }
  END { print failed + 0 }' \
  "$2/history.csv")
[ "$failed" -gt 0 ] || { echo "$2: nothing has failed" >&2; exit 3; }
"$1" figure curves displacement_max "$2" --x-range "$failed:$((failed + 4))" -o "$3"

#!/usr/bin/env bash
# The factor of safety through the flood, as CSV: factors.sh SOLVER STEM.
set -eu -o pipefail
header=
for time in {0..20000..2500}; do
  table=$("$1" "$2.case.h5" --strength-reduction --state "$2.results" --time "$time" 2>/dev/null) || [ $? = 3 ]
  [ -n "$table" ] || continue  # a state without a factor
  [ -n "$header" ] || { header=done; head -1 <<< "$table"; }
  tail -1 <<< "$table"
done

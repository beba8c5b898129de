#!/usr/bin/env bash
# Compares the lens with its plane section, as CSV: compare.sh LENS-HISTORY SECTION-HISTORY. Half of
# the lens is 1.5 m wide, half of the model 6 m.
set -eu -o pipefail
awk -F, '
  FNR == 1 { for (i = 1; i <= NF; ++i) { sub(/ .*/, "", $i); column[i] = $i }; ++file; next }  # without units
  { for (i = 1; i <= NF; ++i) row[column[i]] = $i }
  file == 1 { eroded[row["t"]] = row["eroded"]; flux[row["t"]] = row["flux_in"]; next }
  !said++ { print "t,eroded_section,eroded_lens,discharge_section,discharge_lens" }
  row["t"] in eroded {
    printf "%s,%.6g,%.6g,%.6g,%.6g\n", row["t"], row["eroded"], eroded[row["t"]] / 1.5, row["flux_in"], flux[row["t"]] / 6
  }' "$1" "$2"

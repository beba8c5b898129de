#!/usr/bin/env bash
# Does `make accuracy SHORT=1` work, and does it fail when it must? Works in a folder of its own;
# arguments go to make (BIN=FOLDER).
set -euo pipefail

workflows=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
make_arguments=("$@")
. "$workflows/tests/expect.sh"

# largest LAW RATE TIMES TABLE CONDITION COLUMN OPTION...: compares the reference concentrations of
# the study with a table of exact ones, at the depths of the table, in rows where an awk CONDITION
# on its columns holds.
largest() {
  local law=$1 rate=$2 time=$3 table=$4 condition=$5 value=$6
  shift 6
  awk -v law="$law" -v rate="$rate" -v flux=0.012 -v expansion=0 -v times="$time" -v count=1000 -v across=0 \
    "$@" -f "$workflows/accuracy/profile.awk" > "$work/profile.csv"
  awk -F, 'NR == FNR { if (FNR > 1) c[FNR - 2] = $4; next }
    { sub(/\r$/, "") }
    FNR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    '"$condition"' && $at["x"] > 0 && $at["x"] < 1 {
      k = int($at["x"] * 1000 + 0.5)
      d = (c[k - 1] + c[k]) / 2 - ('"$value"')
      if (d < 0) d = -d
      if (d > most) most = d
      ++rows
    }
    END { print (rows >= 9 && most < 2e-5 ? "close" : rows " rows, " most) }' \
    "$work/profile.csv" "$workflows/../tests/data/reference/$table"
}

expect 'grains along the column, constant law' close "$(largest constant 5e-3 12 fines-profile.csv \
  '$at["law"] == "const" && $at["par"] == 0.005 && $at["q"] == 0.012 && $at["t"] == 12' '$at["c"]')"
expect 'grains along the column, logarithmic law' close "$(largest logarithmic 1e-2 12 fines-profile.csv \
  '$at["law"] == "log" && $at["q"] == 0.012 && $at["t"] == 12' '$at["c"]')"
expect 'grains along the column, first-order law' close "$(largest first-order 0.05 12 fines-profile-first-order-law.csv \
  '$at["t"] == 12' '$at["n_f"] / $at["n_L"]')"
expect 'grains where porosity varies' close "$(largest constant 1e-3 12 fines-profile-nonuniform-porosity.csv \
  '$at["t"] == 12' '$at["c"]' -v n0=0.25 -v slope=0.1)"

# same NAME FACTOR FILE CONDITION TIME VALUE: compares the other references with tables of exact
# values.
same() {
  "$workflows/accuracy/reference.sh" "$1" > "$work/reference.csv"
  awk -F, -v factor="$2" 'NR == FNR { if (FNR > 1) q[$1 + 0] = -$2; next }
    { sub(/\r$/, "") }
    FNR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    '"$4"' && ($at["t"] + 0) in q {
      d = q[$at["t"] + 0] / (factor * $at["'"$5"'"]) - 1
      if (d < 0) d = -d
      if (d > most) most = d
      ++rows
    }
    END { print (rows >= 2 && most < 1e-6 ? "close" : rows " rows, " most) }' \
    "$work/reference.csv" "$workflows/../tests/data/reference/$3"
}
# The table has velocities.
expect 'flux that starts up' close "$(same startup 0.3 flow-startup.csv \
  '$at["case"] == "physical" && $at["quantity"] == "mean_v" && $at["k"] == 0.02' value)"
# The table is for a soil with ten times the conductivity.
expect 'flux that grows with porosity' close "$(same feedback 0.1 permeability-feedback.csv '$at["alpha"] == 0.005' q)"

before=$(cat "$workflows/../docs/evidence/accuracy.md" "$workflows"/../docs/images/*.png | cksum)
status=0
make -C "$workflows" "${make_arguments[@]}" accuracy SHORT=1 OUT="$work/out" > "$work/make.log" 2>&1 || status=$?
[ $status -eq 0 ] || cat "$work/make.log"
expect 'accuracy SHORT=1' 0 $status
grep '^\(ok\|WRONG\): ' "$work/make.log" || true
expect 'it leaves the document as it is' "$before" \
  "$(cat "$workflows/../docs/evidence/accuracy.md" "$workflows"/../docs/images/*.png | cksum)"

out=$work/out/accuracy-short
judge() { awk -F, -v form=check -f "$workflows/accuracy/report.awk" "$1" "$out/left-out.csv" > "$work/judged" && echo right || echo wrong; }
expect 'every problem has its charts' 12 "$(find "$out" -name '*.png' -o -name '*.svg' | wc -l)"
expect 'the table is right' right "$(judge "$out/accuracy.csv")"
sed '2s/concentration,[^,]*/concentration,nan/' "$out/accuracy.csv" > "$work/broken.csv"
expect 'an error that is no number is not' wrong "$(judge "$work/broken.csv")"
grep -v '^dam,sp-implicit' "$out/accuracy.csv" > "$work/broken.csv"
expect 'nor a scheme without runs' wrong "$(judge "$work/broken.csv")"
awk -F, -v OFS=, '$2 == "sp-implicit" { $10 *= 1000 } { print }' "$out/accuracy.csv" > "$work/broken.csv"
expect 'nor an implicit scheme that is slow' wrong "$(judge "$work/broken.csv")"

[ "$failures" -eq 0 ] || { echo "$failures of the checks of accuracy failed"; exit 1; }

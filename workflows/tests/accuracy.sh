#!/usr/bin/env bash
# Does `make accuracy SHORT=1` work, and does it fail when it must? Works in a folder of its own;
# arguments go to make (BIN=FOLDER).
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
work=$scratch

"$workflows/tests/accuracy.py" || failures=$((failures + 1))

documented() { cat "$workflows/../docs/evidence/accuracy.md" "$workflows"/../docs/images/*.png | cksum; }
before=$(documented)
run_make accuracy SHORT=1 OUT="$work/out"
[ "$code" -eq 0 ] || cat "$log"
expect 'accuracy SHORT=1' 0 "$code"
grep '^\(ok\|WRONG\): ' "$log" || true
expect 'it leaves the document as it is' "$before" "$(documented)"

out=$work/out/accuracy-short
judge() { /usr/bin/python3 "$workflows/accuracy/study.py" check "$out" "$1" > "$work/judged" && echo right || echo wrong; }
expect 'every problem has its charts' 12 "$(find "$out" -name '*.png' -o -name '*.svg' | wc -l)"
expect 'the table is right' right "$(judge "$out/accuracy.csv")"
sed '2s/concentration,[^,]*/concentration,nan/' "$out/accuracy.csv" > "$work/broken.csv"
expect 'an error that is no number is not' wrong "$(judge "$work/broken.csv")"
grep -v '^dam,sp-implicit' "$out/accuracy.csv" > "$work/broken.csv"
expect 'nor a scheme without runs' wrong "$(judge "$work/broken.csv")"
awk -F, -v OFS=, '$2 == "sp-implicit" { $10 *= 1000 } { print }' "$out/accuracy.csv" > "$work/broken.csv"
expect 'nor an implicit scheme that is slow' wrong "$(judge "$work/broken.csv")"

finish accuracy

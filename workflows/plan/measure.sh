#!/bin/bash
# Quality of the estimate of a scene: its estimate and its run. With `skips` also the gain by its
# plan: another run with --no-skip.
#
#     measure.sh SOLVER NAME.case.h5 STEM [skips]
#
# Writes STEM.csv, one line without a header (see report.awk), and keeps STEM.explain. Runs that
# take less than `small` seconds are made three times, for the median.
set -eu -o pipefail
solver=$1 case=$2 stem=$3 skips=${4:-}
here=$(dirname "$0")
small=5

# A number of run.json: value KEY FOLDER
value() { sed -n "s/^  \"$1\": \([-+.e0-9]*\),*$/\1/p" "$2/run.json"; }
# Calls of a pass: calls NAME FOLDER
calls() { sed -n "/\"name\": \"$1\"/,/}/s/.*\"calls\": \([0-9]*\),*/\1/p" "$2/run.json"; }
# Seconds of all passes: the time of the run without writing.
pass_seconds() { awk '/"passes":/,/\]/ { if (sub(/.*"seconds": /, "")) sum += $0 } END { print sum }' "$1/run.json"; }
bytes() { find "$1" -type f -printf '%s\n' | awk '{ sum += $1 } END { printf "%.0f", sum }'; }
is_small() { awk -v s="$1" -v most=$small 'BEGIN { exit !(s < most) }'; }

declare -A times=([with]="" [without]="") passes=([with]="" [without]="")
run() { # FOLDER OPTION...
  local folder=$1
  shift
  "$solver" "$case" -o "$stem.$folder.results" --force --quiet "$@" 2> "$stem.$folder.log" ||
    { cat "$stem.$folder.log" >&2; exit 1; }
  times[$folder]+="$(value wall_seconds "$stem.$folder.results")"$'\n'
  passes[$folder]+="$(pass_seconds "$stem.$folder.results")"$'\n'
}
median() { printf '%s' "$1" | sort -g | awk '{ t[NR] = $1 } END { print t[int((NR + 1) / 2)] }'; }

"$solver" "$case" --explain > "$stem.explain"
both() {
  run with
  [ -z "$skips" ] || run without --no-skip
}
both
if is_small "${times[with]}"; then
  for again in 2 3; do both; done
fi

line() { # COLUMNS...: those that need a run without a plan are empty if there is none
  printf '%s,' "$(basename "$stem")" "$@" "$(value memory_bytes "$stem.with.results")" "$(bytes "$stem.with.results")"
  awk -f "$here/estimate.awk" "$stem.explain"
}
if [ -z "$skips" ]; then
  line "$(median "${times[with]}")" "" "$(median "${passes[with]}")" "" "$(value steps "$stem.with.results")" "" "" "" "" \
    > "$stem.csv.tmp"
  mv "$stem.csv.tmp" "$stem.csv"
  rm -rf "$stem.with.results"
  exit
fi

# A flow that was kept differs from the solved one within time.tolerance; everything else is exact.
kept=$(calls "flow, steady and kept" "$stem.with.results")
bound=1e-12 leave=
if [ "${kept:-0}" -gt 0 ]; then
  # A given step has no tolerance: the default is taken.
  tolerance=$(sed -n 's/.*steps chosen for a local error of \([-+.e0-9]*\).*/\1/p' "$stem.explain")
  bound=$(awk -v t="${tolerance:-1e-3}" 'BEGIN { print 0.1 * t }')
  # These columns are not results: they say how long steps are and how large errors are.
  leave="dt residual_water residual_grains eos_error pressure_overshoot pressure_scatter volume_defect"
fi
apart="0 -"
for table in history ledger; do
  found=$(awk -F, -v leave="$leave" -f "$here/compare.awk" "$stem".{with,without}.results/$table.csv)
  apart=$(printf '%s\n%s\n' "$apart" "$found" | sort -gr | head -n 1)
done

line "$(median "${times[with]}")" "$(median "${times[without]}")" \
  "$(median "${passes[with]}")" "$(median "${passes[without]}")" \
  "$(value steps "$stem.with.results")" "$(value steps "$stem.without.results")" "${apart/ /,}" "$bound" > "$stem.csv.tmp"
mv "$stem.csv.tmp" "$stem.csv"
rm -rf "$stem.with.results" "$stem.without.results"

#!/bin/bash
# Wall time and error of every run of a problem.
#
#     measure.sh BIN PROBLEM REFERENCE.csv OUT [short]
#
# Writes OUT/PROBLEM.csv, a line per run without a header, and OUT/PROBLEM.left-out.csv, a line per
# run that was left out because --explain says that it would take too long. Runs are timed, so they
# are made one after the other, whatever -j.
set -eu -o pipefail
bin=$1 problem=$2 reference=$3 out=$4 form=${5:-full}
here=$(cd "$(dirname "$0")" && pwd)
# The longest run, in seconds, and the number of repetitions for the median.
limit=${ACCURACY_LIMIT:-6} repetitions=${ACCURACY_REPETITIONS:-5}
# In the short form, runs that take longer than this are made once.
once=0
if [ "$form" == short ]; then
  limit=1 repetitions=1
  # The check of the short form judges the times of this problem.
  [ "$problem" != fines-constant ] || limit=10 repetitions=3 once=0.5
fi
# A run of the next size takes 8 times as long, or a little more.
growth=16

work=$out/$problem.work
rm -rf "$work"
mkdir -p "$work"
trap 'rm -rf "$work"' EXIT

# A number of run.json: value KEY
value() { sed -n "s/^  \"$1\": \([-+.e0-9]*\),*$/\1/p" "$work/run.results/run.json"; }
exceeds() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a > b) }'; }
solve() {
  "$bin/suffuse-solver" "$work/run.case.h5" -o "$work/run.results" --force --quiet 2> "$work/log" ||
    { echo "accuracy: $problem: $*" >&2; cat "$work/log" >&2; exit 1; }
}

: > "$out/$problem.csv.tmp"
: > "$out/$problem.left-out.csv.tmp"
declare -A last=()
while read -r scheme size points tolerance changes; do
  row=$problem,$scheme,$size,$points,${tolerance/#-/}
  series=$scheme,$points,$tolerance
  read -ra keys <<< "$changes"
  "$bin/suffuse-mesher" "$here/$problem.toml" -o "$work/run.case.h5" "${keys[@]/#/--set=}" > /dev/null
  # Nothing is known yet of the first run in a series.
  if exceeds "${last[$series]:-$limit}" "$(awk -v l=$limit -v g=$growth 'BEGIN { print l / g }')"; then
    "$bin/suffuse-solver" "$work/run.case.h5" --explain > "$work/explain" 2> "$work/log"
    estimate=$(awk -f "$here/../plan/estimate.awk" "$work/explain")
    expected=$(cut -d, -f2 <<< "$estimate")
    if exceeds "${expected:-1e9}" $limit; then  # no estimate if steps take too long to be tried
      echo "$row,$(cut -d, -f1,2 <<< "$estimate")" >> "$out/$problem.left-out.csv.tmp"
      last[$series]=$limit
      continue
    fi
  fi
  seconds=
  for ((repetition = 0; repetition < repetitions; ++repetition)); do
    solve "$row"
    seconds+="$(value wall_seconds)"$'\n'
    [ "$form" != short ] || ! exceeds "$(value wall_seconds)" $once || break
  done
  median=$(printf '%s' "$seconds" | sort -g | awk '{ t[NR] = $1 } END { print t[int((NR + 1) / 2)] }')
  last[$series]=$median
  "$bin/suffuse-post" error "$work/run.results" --reference "$reference" --csv "$work/error.csv" > /dev/null
  errors=$(awk -F, 'NR == 2 { print $1 "," $3 "," $4 "," $5 }' "$work/error.csv")
  echo "$row,$errors,$median,$(value steps),$(value elements),$(($(value solid_points) + $(value liquid_points))),$(
    value memory_bytes),$(value threads)" >> "$out/$problem.csv.tmp"
done < <("$here/variants.sh" "$problem" "$form")
mv "$out/$problem.left-out.csv.tmp" "$out/$problem.left-out.csv"
mv "$out/$problem.csv.tmp" "$out/$problem.csv"

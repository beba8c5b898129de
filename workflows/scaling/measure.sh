#!/bin/bash
# Measures the cost of each stage of the pipeline for a column of a given size.
#
#     measure.sh PROGRAMS SCENE.toml MODE ELEMENTS THREADS STEM
#
# PROGRAMS is the folder of the three programs; MODE one of sp-explicit, sp-implicit,
# dp-material-point, dp-mixed, dp-implicit. Writes STEM.csv, a header and one line. Stages that take
# less than a few seconds are repeated, and the median is taken.
set -eu -o pipefail
programs=$1 scene=$2 mode=$3 elements=$4 threads=$5 stem=$6
small=4

# Two triangles per square of the unit column.
size=$(awk -v n="$elements" 'BEGIN { printf "%.17g", 1 / int(sqrt(n / 2) + 0.5) }')
steps=$(awk -v n="$elements" 'BEGIN { print n <= 2e4 ? 200 : n <= 2e5 ? 50 : 20 }')

# Explicit steps are nine tenths of the stability limit, which is proportional to the size of an
# element; in implicit steps the liquid passes a tenth of an element.
times() { awk -v h="$size" -v n="$1" -v per_size="$2" 'BEGIN { printf "step=%.6g,end=%.6g", per_size * h, n * per_size * h }'; }
changes=()
case $mode in
  sp-explicit | dp-material-point | dp-mixed) time="{scheme=\"explicit\",$(times "$steps" 3.5e-3)}" ;;
  sp-implicit | dp-implicit)
    steps=20
    time="{inertia=false,$(times $steps 2.0)}"
    # Permeability changes with porosity, so the flow is solved in every step.
    changes+=('soil.specimen.conductivity_law=kozeny-carman') ;;
  *) echo "measure.sh: got mode '$mode'" >&2; exit 2 ;;
esac
case $mode in
  dp-*) changes+=(formulation=double-point points.solid_per_element=1 points.liquid_per_element=12) ;;
esac
case $mode in
  dp-material-point) changes+=(flow.integration=material-point) ;;
  dp-mixed) changes+=(flow.integration=mixed) ;;
esac
end=${time##*end=}
set_options=(--set "name=$mode" --set "mesh.size=$size" --set "time=$time" --set "output.every=${end%\}}")
for change in "${changes[@]}"; do set_options+=(--set "$change"); done

value() { sed -n "s/^  \"$1\": \([-+.e0-9]*\),*$/\1/p" "$stem.results/run.json"; }
# Seconds of all passes whose names match.
pass_seconds() {
  awk -v name="$1" '/"passes":/, /\]/ {
    if (/"name":/) wanted = $0 ~ "\"name\": \"" name
    if (wanted && sub(/.*"seconds": /, "")) sum += $0
  } END { printf "%.6g", sum }' "$stem.results/run.json"
}
now() { date +%s.%N; }
columns=mesher,ledger,picture,solver,passes,flow,movement,erosion,coefficients
once() { # times of one run through the pipeline, separated by commas
  local t0 t1 t2 t3 t4
  t0=$(now)
  "$programs/suffuse-mesher" "$scene" "${set_options[@]}" -o "$stem.case.h5" > /dev/null
  t1=$(now)
  "$programs/suffuse-solver" "$stem.case.h5" -o "$stem.results" --force --threads "$threads" --quiet
  t2=$(now)
  "$programs/suffuse-post" ledger "$stem.results" > /dev/null
  t3=$(now)
  "$programs/suffuse-post" render "$stem.results" --field porosity -o "$stem.png" > /dev/null
  t4=$(now)
  awk -v a="$t0" -v b="$t1" -v c="$t2" -v d="$t3" -v e="$t4" 'BEGIN { printf "%.4f,%.4f,%.4f,%.4f,", b - a, d - c, e - d, c - b }'
  printf '%s,' "$(pass_seconds '')" "$(pass_seconds '(flow|exchange)')" "$(pass_seconds '(transport|movement)')" \
    "$(pass_seconds erosion)"
  pass_seconds '(water|coefficients)'
  echo
}
lines=$(once)
if awk -v line="$lines" -v most=$small 'BEGIN { split(line, t, ","); exit !(t[1] + t[2] + t[3] + t[4] < most) }'; then
  for _ in 2 3 4 5; do lines+=$'\n'$(once); done
fi
medians=$(for k in 1 2 3 4 5 6 7 8 9; do
  cut -d, -f$k <<< "$lines" | sort -g | awk '{ t[NR] = $1 } END { print t[int((NR + 1) / 2)] }'
done | paste -sd,)

{
  echo "mode,threads,elements,solid_points,liquid_points,steps,memory,case_bytes,$columns"
  printf '%s,' "$mode" "$threads" "$(value elements)" "$(value solid_points)" "$(value liquid_points)" \
    "$(value steps)" "$(value memory_bytes)" "$(stat -c %s "$stem.case.h5")"
  echo "$medians"
} > "$stem.csv.tmp"
mv "$stem.csv.tmp" "$stem.csv"
rm -rf "$stem.results" "$stem.case.h5" "$stem.png"

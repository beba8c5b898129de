#!/bin/bash
# Thirty days by both transports: error against run time. month.sh BIN OUT > month.csv
set -eu -o pipefail
bin=$1 out=$2
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$out"
echo transport,size,tolerance,steps,seconds,error
for size in 0.125 0.0625 0.03125; do
  for variant in explicit,1e-3 implicit,1e-2 implicit,1e-3 implicit,1e-4; do
    transport=${variant%,*} tolerance=${variant#*,}
    "$bin/suffuse-mesher" "$here/month.toml" -o "$out/month.case.h5" --set mesh.size="$size" --set time.transport="$transport" \
      --set time.tolerance="$tolerance" > "$out/month.log"
    rm -rf "$out/month.results"
    start=$(date +%s.%N)
    "$bin/suffuse-solver" "$out/month.case.h5" -o "$out/month.results" --quiet
    seconds=$(awk "BEGIN { printf \"%.2f\", $(date +%s.%N) - $start }")
    name=transport$([ "$transport" = explicit ] || echo ", implicit")
    steps=$(grep -A1 "\"name\": \"$name\"" "$out/month.results/run.json" | sed -n "s/.*\"calls\": *\([0-9]*\).*/\1/p")
    "$bin/suffuse-post" table "$out/month.results" --csv "$out/month.run.csv"
    error=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "error_fines_relative") k = i } NR == 2 { print $k }' "$out/month.run.csv")
    echo "$transport,$size,$tolerance,$steps,$seconds,$error"
  done
done

#!/bin/bash
# Solves the dam on a mesh adapted to its flow: dam-reference.sh BIN OUT > dam.csv. Takes some
# minutes. All other runs are compared with the lines that it prints.
set -eu -o pipefail
bin=$1 out=$2
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$out"
"$here/../adapt.sh" "$bin" "$here/dam.toml" "$out/dam-reference" --set mesh.structure=free --set mesh.error=3e-5 \
  --set mesh.max_elements=600000 --set time.tolerance=1e-4 > "$out/dam-reference.log"
"$bin/suffuse-solver" "$out/dam-reference.case.h5" -o "$out/dam-reference.results" --force --quiet
echo t,x,y,concentration
for t in 5 10; do
  for y in 0.25 0.5 0.75; do
    "$bin/suffuse-post" sample "$out/dam-reference.results" --time $t --line 0.03,$y:2.97,$y --count 40 \
      --fields concentration --csv "$out/dam-reference.line.csv"
    awk -F, -v t=$t 'NR > 1 { printf "%s,%.12g,%.12g,%.6g\n", t, $2, $3, $4 }' "$out/dam-reference.line.csv"
  done
done

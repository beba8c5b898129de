#!/bin/bash
# What two ranks gain: linear systems of the flow of up to a million faces and the bandwidth of the machine (tests/bench/ranks_bench.cpp),
# and whole explicit steps with transport.
#
#     ranks.sh PROGRAMS SCENE.toml OUT
#
# PROGRAMS is the folder of the programs, SCENE the basin of the tests. Prints a table; ROWS=N takes systems of N rows alone.
set -eu -o pipefail
programs=$1 scene=$2 out=$3
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
for ranks in 1 2; do
  mpirun -q --bind-to none -n $ranks "$programs/ranks_bench" ${ROWS:-} > "$out/systems-$ranks.csv"
done
cp "$(dirname "$scene")"/*.geo "$out"
"$programs/suffuse-mesher" "$scene" --set mesh.size="${SIZE:-0.0044}" --set time.end=1e-3 --set output.every=1e-3 \
  --set output.snapshot_every=1e-3 -o "$out/basin.case.h5" > "$out/basin.log" 2>&1
"$programs/suffuse-solver" "$out/basin.case.h5" --explain --ranks 2 2>> "$out/basin.log" | grep '^trial' > "$out/steps.txt"
awk -F, '
  FNR == NR && /^# triad/ { split($0, w, " "); triad = w[6]; next }
  /^# triad/ { split($0, w, " "); ratio = w[6] / triad; next }
  /^ranks/ { next }
  FNR == NR { its[FNR] = $5; setup[FNR] = $6; each[FNR] = $7; next }
  { lines = lines sprintf("| %sD | %.3g | %.0e | %d | %d | %.3g | %.2f | %.3g | %.2f |\n", $2, $3, $4, its[FNR], $5,
                          1e3 * setup[FNR], setup[FNR] / $6, 1e3 * each[FNR], each[FNR] / $7) }
  END {
    printf "Bandwidth of two ranks over that of one: %.2f.\n\n", ratio
    print "| | rows | contrast | iterations, 1 rank | 2 ranks | set-up, ms | gain | iteration, ms | gain |"
    print "|---|---|---|---|---|---|---|---|---|"
    printf "%s", lines
  }' "$out/systems-1.csv" "$out/systems-2.csv"
echo
cat "$out/steps.txt"

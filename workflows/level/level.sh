#!/usr/bin/env bash
# The critical level of a scene, or its fragility, in OUT_FOLDER/TARGET/NAME/: level.sh TARGET
# CALLED_FROM with the TARGET critical-level or fragility. make calls it, with its variables in the
# environment and itself as MAKE. The runs are one sweep in the folder runs/, whose table grows round
# by round: which levels follow depends on the runs before.
set -eu -o pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. ./find_file.sh
target=$1 called_from=$2
scene=$(find_file SCENE "$called_from")
if [ "$target" = fragility ]; then SWEEP=$(find_file SWEEP "$called_from"); fi
file=$(basename -- "$scene")
folder=$OUT_FOLDER/$target/${NAME:-${file%.*}}
PROGRAMS=$(realpath -- "$PROGRAMS")
export PROGRAMS SWEEP
study() { "$PYTHON" "level/${target//-/_}.py" "$1" "$scene" "$folder"; }

made=
while true; do
  states=$(study prepare)
  if [ "$(< "$folder/table.csv")" = "$made" ]; then break; fi
  made=$(< "$folder/table.csv")
  code=0
  SWEEP=$(realpath -- "$folder/table.csv") SCENE=$scene FACTOR=$states SWEEP_FOLDER=$folder/runs \
    sweep/sweep.sh "$called_from" || code=$?
  # Soil that fails in a run is an answer, not the end of the study.
  if [ "$code" -gt 1 ]; then exit "$code"; fi
done
study conclude

#!/usr/bin/env bash
# A sweep from its table to its figures, in OUT_FOLDER/sweep/NAME/: sweep.sh CALLED_FROM. make calls
# it, with its variables in the environment and itself as MAKE; its -j holds for the runs. With
# SWEEP_FOLDER the sweep is in that folder and has no figures.
set -eu -o pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. ./find_file.sh
if [ -z "$SCENE$SWEEP" ]; then SCENE=sweep/weir.toml SWEEP=sweep/weir.csv; fi
scene=$(find_file SCENE "$1")
table=$(find_file SWEEP "$1")
name=$(basename -- "$table")
folder=${SWEEP_FOLDER:-$OUT_FOLDER/sweep/${NAME:-${name%.*}}}
PROGRAMS=$(realpath -- "$PROGRAMS")
export PROGRAMS RUN=$PWD/sweep/run.sh

"$PYTHON" sweep/sweep.py prepare "$scene" "$table" "$folder" --programs "$PROGRAMS"
# A run that was stopped or killed does not stop the others.
$MAKE -k -C "$folder" -f "$PWD/sweep/rows.mk" || true
"$PYTHON" sweep/sweep.py conclude "$folder" --programs "$PROGRAMS" ${SWEEP_FOLDER:+--no-figures}

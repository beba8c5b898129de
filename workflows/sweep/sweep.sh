#!/usr/bin/env bash
# A sweep from its table to its figures, in OUT_FOLDER/sweep/NAME/: sweep.sh CALLED_FROM. make calls
# it, with its variables in the environment and itself as MAKE; its -j holds for the runs. With
# SWEEP_FOLDER the sweep is in that folder and has no figures. With FACTOR=1 it looks at how safe the
# last state of each run is; FACTOR=all, start and checks: assess.sh. REGION and DEEPER leave soil out.
set -eu -o pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. ./find_file.sh
if [ -z "$SCENE$SWEEP" ]; then SCENE=examples/weir/weir.toml SWEEP=sweep/weir.csv; fi
scene=$(find_file SCENE "$1")
table=$(find_file SWEEP "$1")
name=$(basename -- "$table")
folder=${SWEEP_FOLDER:-$OUT_FOLDER/sweep/${NAME:-${name%.*}}}
PROGRAMS=$(realpath -- "$PROGRAMS")
# rows.mk would see the FACTOR of the command line, so the states have a variable of their own.
case ${FACTOR:-} in
  '' | 0) STATES= ;;
  1) STATES=last ;;
  last | all | start | checks) STATES=$FACTOR ;;
  *)
    echo "FACTOR: got '$FACTOR'; expected 1, all, start or checks" >&2
    exit 2
    ;;
esac
reduction=
if [ -n "${REGION:-}${DEEPER:-}" ]; then reduction=$("$PYTHON" sweep/assessment.py "$scene" "$table" "$STATES"); fi
options=(--programs "$PROGRAMS" ${STATES:+--factor "$STATES"})

"$PYTHON" sweep/sweep.py prepare "$scene" "$table" "$folder" "${options[@]}"
# The date of assess.inputs says since when runs are looked at in this way.
if [ -n "$STATES" ] && [ "$(cat -- "$folder/assess.options" 2> /dev/null)" != "$reduction" ]; then
  touch -- "$folder/assess.inputs"
  echo "$reduction" > "$folder/assess.options"
fi
export PROGRAMS STATES RUN=$PWD/sweep/run.sh ENDED=status
# assess.sh has the options of the strength reduction behind the states.
if [ -n "$STATES" ]; then STATES="$STATES $reduction" RUN=$PWD/sweep/assess.sh ENDED=assessed; fi
# A run that was stopped or killed does not stop the others.
$MAKE -k -C "$folder" -f "$PWD/sweep/rows.mk" || true
"$PYTHON" sweep/sweep.py conclude "$folder" "${options[@]}" ${SWEEP_FOLDER:+--no-figures}

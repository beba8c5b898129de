#!/usr/bin/env bash
# A study of convergence in OUT_FOLDER/convergence/NAME/: convergence.sh CALLED_FROM. make calls it,
# with its variables in the environment and itself as MAKE. The runs are a sweep over mesh.size and
# time.tolerance, in the folder runs/.
set -eu -o pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. ./find_file.sh
called_from=$1
scene=$(find_file SCENE "$called_from")
file=$(basename -- "$scene")
folder=$OUT_FOLDER/convergence/${NAME:-${file%.*}}
PROGRAMS=$(realpath -- "$PROGRAMS")
export PROGRAMS
study() { "$PYTHON" convergence/convergence.py "$@"; }

# make_runs OPTION...: prepares the table of the sweep and makes its runs.
make_runs() {
  study prepare "$scene" "$folder" --programs "$PROGRAMS" "$@"
  SCENE=$scene SWEEP=$(realpath -- "$folder/table.csv") SWEEP_FOLDER=$folder/runs sweep/sweep.sh "$called_from"
}

# The coarsest run shows which outputs there are, before the others cost time.
if [ ! -e "$folder/runs/sweep.csv" ]; then make_runs --first; fi
study outputs "$folder"
make_runs
study conclude "$folder" --programs "$PROGRAMS"

#!/usr/bin/env bash
# A study of convergence in OUT_FOLDER/convergence/NAME/: convergence.sh CALLED_FROM. make calls it,
# with its variables in the environment and itself as MAKE. The runs are a sweep over mesh.size and
# time.tolerance, in the folder runs/.
set -eu -o pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. ./find_file.sh
scene=$(find_file SCENE "$1")
file=$(basename -- "$scene")
folder=$OUT_FOLDER/convergence/${NAME:-${file%.*}}
PROGRAMS=$(realpath -- "$PROGRAMS")
export PROGRAMS
study() { "$PYTHON" convergence/convergence.py "$@"; }

# The first call makes only the coarsest run, unless it is there, to see which outputs there are.
for first in --first ''; do
  study prepare "$scene" "$folder" --programs "$PROGRAMS" $first
  SCENE=$scene SWEEP=$(realpath -- "$folder/table.csv") SWEEP_FOLDER=$folder/runs sweep/sweep.sh "$1"
  study outputs "$folder"
done
study conclude "$folder" --programs "$PROGRAMS"

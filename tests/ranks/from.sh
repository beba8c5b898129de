#!/bin/sh
# A run that starts from the end of another has the same files on several ranks as in one process,
# byte by byte, but for run.json.
#   from.sh FOLDER_OF_PROGRAMS MPIRUN SCENE.toml RANKS [MESHER OPTION...]
set -eu
programs=$1 mpirun=$2 scene=$3 ranks=$4
shift 4
. "$(dirname "$0")/expect_same.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cp "$(dirname "$scene")"/*.geo .
"$programs/suffuse-mesher" "$scene" -o first.h5 "$@" > mesher.log 2>&1
"$programs/suffuse-solver" first.h5 -o first --quiet 2> first.log
sed -e 's|^water_level.*|from = "first"|' "$scene" > scene.toml
"$programs/suffuse-mesher" scene.toml -o case.h5 "$@" > mesher.log 2>&1 || { cat mesher.log; exit 1; }
"$programs/suffuse-solver" case.h5 -o alone --quiet 2> alone.log
"$mpirun" -q --oversubscribe -n "$ranks" "$programs/suffuse-solver-mpi" case.h5 -o shared --quiet 2> shared.log ||
  { cat shared.log; exit 1; }
expect_same alone shared
grep -q '"run: from the state of' shared/run.json

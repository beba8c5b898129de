#!/bin/sh
# A run on four ranks goes on with two, then in one process, and has the files of a run that never
# stopped, byte by byte, but for run.json.
#   resume.sh FOLDER_OF_PROGRAMS MPIRUN SCENE.toml [MESHER OPTION...]
set -eu
programs=$1 mpirun=$2 scene=$3
shift 3
. "$(dirname "$0")/expect_same.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$programs/suffuse-mesher" "$scene" -o case.h5 --set output.restarts=10 "$@" > mesher.log 2>&1
on_ranks() {
  count=$1
  shift
  "$mpirun" -q --oversubscribe -n "$count" "$programs/suffuse-solver-mpi" case.h5 --quiet "$@"
}
"$programs/suffuse-solver" case.h5 -o alone --quiet 2> alone.log
on_ranks 4 -o shared 2> shared.log
expect_same alone shared
grep -q '"resumed_at": null' shared/run.json
# Without its last snapshots a run goes on from the one before.
forget() {
  for number in "$@"; do rm shared/snapshots/*_00000"$number".hdf; done
}
goes_on_from() {
  grep -q "\"resumed_at\": $1" shared/run.json
}
forget 3 4 5
on_ranks 2 -o shared --resume 2> shared.log
goes_on_from 0.04
expect_same alone shared
forget 4 5
"$programs/suffuse-solver" case.h5 -o shared --resume --quiet 2> shared.log
goes_on_from 0.06
expect_same alone shared
forget 2 3 4 5
on_ranks 3 -o shared --resume 2> shared.log
goes_on_from 0.02
expect_same alone shared
# A complete run is left alone.
"$mpirun" -q --oversubscribe -n 2 "$programs/suffuse-solver-mpi" case.h5 -o shared --resume 2> shared.log
grep -q "shared is complete: nothing to resume" shared.log
test "$(wc -l < shared.log)" -eq 2

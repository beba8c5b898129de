#!/bin/sh
# Runs a scene on one process and on several ranks: all files have to be the same, byte by byte, but
# for run.json, and the messages too.
#   same_files.sh FOLDER_OF_PROGRAMS MPIRUN SCENE.toml RANKS [MESHER OPTION...]
set -eu
programs=$1 mpirun=$2 scene=$3 ranks=$4
shift 4
. "$(dirname "$0")/expect_same.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$programs/suffuse-mesher" "$scene" -o case.h5 "$@" > mesher.log 2>&1 || { cat mesher.log; exit 1; }
code=0
"$programs/suffuse-solver" case.h5 -o alone --quiet 2> alone.log || code=$?
code_on_ranks=0
"$mpirun" -q --oversubscribe -n "$ranks" "$programs/suffuse-solver-mpi" case.h5 -o shared --quiet \
  2> shared.log || code_on_ranks=$?
test $code -eq $code_on_ranks || { echo "exit codes $code and $code_on_ranks"; cat shared.log; exit 1; }
# On ranks a warning of locking is not given: it takes the steady flow.
sed -e 's/suffuse-solver-mpi/suffuse-solver/' shared.log > shared.txt
grep -v 'does not follow this flow' alone.log > alone.txt || true
diff alone.txt shared.txt
expect_same alone shared
# Both say the same of their end.
for key in status message; do
  grep "\"$key\"" alone/run.json > alone.txt
  grep "\"$key\"" shared/run.json | diff alone.txt -
done

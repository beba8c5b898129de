#!/usr/bin/env bash
# One scene from its mesh to its figures, in OUT_FOLDER/study/: study.sh CALLED_FROM. make calls it,
# with its variables in the environment. A second call makes only files that are missing or out of
# date.
set -eu -o pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. ./find_file.sh
scene=$(find_file SCENE "$1")
programs=$(realpath -- "$PROGRAMS")
file=$(basename -- "$scene")
stem=$OUT_FOLDER/study/${file%.*}

"$PYTHON" sweep/inputs.py "$scene" "$programs" "$stem"
# The cause of an earlier failure may be mended, so its status is removed.
if [ -e "$stem.status" ] && [ "$(head -1 "$stem.status")" != done ]; then rm "$stem.status"; fi
PROGRESS=1 sweep/run.sh "$programs" "$stem" "$TOLERANCE"
case $(head -1 "$stem.status") in
  done) ;;
  refused) exit 2 ;;
  *) exit 3 ;;
esac

# make_file FILE COMMAND ARGUMENT...: calls the command of suffuse-post that makes the file, if it
# is out of date.
make_file() {
  local file=$1
  shift
  if [ "$file" -nt "$stem.status" ] && [ "$file" -nt "$programs/suffuse-post" ]; then return; fi
  echo "suffuse-post $*"
  "$programs/suffuse-post" "$@" "$file"
}

make_file "$stem.history.csv" history "$stem.results" --csv
for figure in porosity masses; do
  for format in png svg; do make_file "$stem.$figure.$format" figure "$figure" "$stem.results" -o; done
done
make_file "$stem.html" report "$stem.results" -o
echo "The study's figures, tables and results are $(realpath -- "$OUT_FOLDER/study")/${file%.*}.*"

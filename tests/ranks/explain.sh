#!/bin/sh
# --explain --ranks N: a line for 1, 2, 4, and so on, up to N ranks, each from the same steps, and how many to take; what cannot run
# on ranks is refused.
#   explain.sh FOLDER_OF_PROGRAMS SCENE.toml
set -eu
programs=$1 scene=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cp "$(dirname "$scene")"/*.geo .
"$programs/suffuse-mesher" "$scene" -o case.h5 --set mesh.size=0.16 --set time.end=2e-3 > mesher.log 2>&1
"$programs/suffuse-solver" case.h5 --explain --ranks 3 > text 2> errors || { cat text errors; exit 1; }
cat text
said() { grep -q "$1" text || { echo "expected: $1"; exit 1; }; }
steps=$(sed -n 's/^trial on 1 rank: \([0-9]*\) steps, .*/\1/p' text)
test "${steps:-0}" -ge 3
for ranks in 2 3; do
  said "^trial on $ranks ranks: $steps steps, [0-9.e-]* s each, [0-9]* MB of memory in all, [0-9]* MB in the largest process$"
done
test "$(grep -c '^trial on' text)" = 3
said '^recommended on this machine: '
said '^estimate: '

"$programs/suffuse-mesher" "$scene" -o steady.h5 --set mesh.size=0.16 --set initial.flow=steady > mesher.log 2>&1
code=0
"$programs/suffuse-solver" steady.h5 --explain --ranks 2 > text 2> errors || code=$?
test "$code" = 2
grep -q 'initial.flow' errors
test ! -s text

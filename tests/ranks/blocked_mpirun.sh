#!/bin/sh
# A run on ranks ends with exit code 3 where mpirun does not end after its processes have.
#   blocked_mpirun.sh FOLDER_OF_PROGRAMS SCENE.toml
set -eu
programs=$1 scene=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$programs/suffuse-mesher" "$scene" -o case.h5 --set mesh.size=0.3 > mesher.log 2>&1
mkdir bin
cat > bin/mpirun <<'END'
#!/bin/sh
echo $$ > blocked
sleep 0.5
exec sleep 600
END
chmod +x bin/mpirun
code=0
PATH="$folder/bin:$PATH" timeout 60 "$programs/suffuse-solver" case.h5 -o shared --quiet --ranks 2 2> log || code=$?
test $code -eq 3 || { echo "exit code $code; expected 3"; cat log; exit 1; }
grep -q 'mpirun did not end after its processes had; --resume goes on' log || { cat log; exit 1; }
if kill -0 "$(cat blocked)" 2> /dev/null; then echo "mpirun goes on"; exit 1; fi

#!/bin/sh
# Ends runs on ranks in rude ways at random times: a rank or mpirun is killed, the launcher gets SIGINT,
# SIGTERM or SIGUSR1 or is killed. Each run goes on with another number of ranks until it is done, and has the files of
# a run that never stopped, byte by byte, but for run.json.
#   kills.sh FOLDER_OF_PROGRAMS SCENE.toml KILLS SEED
set -eu
programs=$1 scene=$2 kills=$3 seed=$4
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$programs/suffuse-mesher" "$scene" -o case.h5 --set time.end=0.3 --set mesh.size=0.06 > mesher.log 2>&1
"$programs/suffuse-solver" case.h5 -o alone --quiet 2> alone.log
random() {
  seed=$(((seed * 1103515245 + 12345) % 2147483648))
  echo $((seed / 65536 % $1))
}
fail() {
  echo "$*"
  cat log
  exit 1
}
# The processes of the run below a process, mpirun first.
children() { pgrep -P "$1" || true; }
# Kills an mpirun that has had no processes for ten seconds: that of Open MPI 4.1 may block itself as it ends (a mutex in
# PMIx_server_finalize), some once in hundreds of runs.
end_blocked() {
  alone=0
  while kill -0 "$1" 2> /dev/null && [ $alone -lt 20 ]; do
    if [ -n "$(children "$1")" ]; then alone=0; else alone=$((alone + 1)); fi
    sleep 0.5
  done
  if kill -KILL "$1" 2> /dev/null; then touch blocked; fi
}
attempt=0 killed=0 resumed=0
rm -rf shared
# Runs that are done before they are killed do not count; most of them are not.
while [ "$killed" -lt "$kills" ] && [ "$attempt" -lt $((6 * kills)) ]; do
  attempt=$((attempt + 1))
  random 4 > number
  ranks=$(($(cat number) + 2))
  seed=$((seed + attempt))
  if [ -d shared ]; then mode=--resume; else mode=--quiet; fi
  "$programs/suffuse-solver" case.h5 -o shared --quiet $mode --ranks $ranks --checkpoint-every 0.1 2> log &
  launcher=$!
  random 10 > number
  tenths=$(($(cat number) + 3))
  sleep "$((tenths / 10)).$((tenths % 10))"
  seed=$((seed + attempt))
  random 6 > number
  way=$(cat number)
  mpirun=$(children $launcher | head -1)
  case $way in
    0) target=$(children "${mpirun:-0}" | tail -1) signal=KILL expected='137 3' ;;
    1) target=$mpirun signal=KILL expected='3' ;;
    2) target=$launcher signal=INT expected='130' ;;
    3) target=$launcher signal=TERM expected='130' ;;
    4) target=$launcher signal=KILL expected='137' ;;
    5) target=$launcher signal=USR1 expected='130' ;;
  esac
  if [ -n "$target" ] && kill -$signal "$target" 2> /dev/null; then killed=$((killed + 1)); fi
  rm -f blocked
  if [ -n "$mpirun" ]; then end_blocked "$mpirun" & fi
  code=0
  wait $launcher || code=$?
  wait
  if [ -e blocked ]; then expected="$expected 3"; fi
  # One that was done before the signal came is no kill.
  if [ $code -eq 0 ]; then
    killed=$((killed - 1))
  elif ! echo " $expected " | grep -q " $code "; then
    fail "way $way: exit code $code; expected $expected"
  fi
  # Ranks of a launcher that was killed write a checkpoint first.
  for wait in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    pgrep -f "suffuse-solver-mpi case.h5 -o shared" > /dev/null || break
    sleep 0.25
  done
  ! pgrep -f "suffuse-solver-mpi case.h5 -o shared" > /dev/null || fail "way $way: a rank outlived its run"
  if [ $code -eq 0 ]; then
    (cd alone && find . -type f ! -name run.json ! -name '.*' | sort) > files
    (cd shared && find . -type f ! -name run.json ! -name '.*' | sort) | diff files - || fail "files differ"
    while read -r file; do cmp "alone/$file" "shared/$file" || fail "$file differs"; done < files
    if ! grep -q '"resumed_at": null' shared/run.json; then resumed=$((resumed + 1)); fi
    rm -rf shared
  fi
done
test "$killed" -gt 0 || fail "no run was killed"
echo "$killed kills in $attempt runs, $resumed of which went on to the end"

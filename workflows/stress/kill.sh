#!/bin/bash
# Is anything lost when runs are killed? Kills runs at random moments, several times in a row,
# resumes each until it is done, and compares every file with that of an undisturbed run.
#
#     kill.sh PROGRAMS FOLDER KILLS
#
# PROGRAMS is the folder of the three programs. Writes FOLDER/kill.csv, a line per formulation and
# scheme, and prints it as a table. Fails if a snapshot that a series names cannot be read, if a run
# does not go on, or if its files differ at the end; such a run stays in FOLDER. SEED=N: other
# moments.
set -u -o pipefail
programs=$(cd "$1" && pwd) folder=$2 kills=$3
scenes=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
modes=(sp-explicit sp-implicit sp-moving sp-failing dp-explicit dp-implicit dp-points dp-moving)
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
RANDOM=${SEED:-1}

# A column that a load squeezes by half an element while its fines erode.
moving() {
  echo --set 'time={end=4.0,tolerance=2e-3}' --set 'soil.specimen.skeleton={law="elastic",young=3e5,poisson=0.2}'
  echo --set 'boundary[0]={on="top",pressure=[[0.0,2e3],[2.0,6e3]],concentration=0.01,traction=[[0.0,0.0,-2e3],[2.0,0.0,-3e4]]}'
  echo --set 'boundary[1]={on="bottom",pressure=0.0,concentration=0.0,fix="both"}'
  echo --set 'boundary[2]={on="left",fix="normal"}' --set 'boundary[3]={on="right",fix="normal"}'
}

# Runs of half a second with forty snapshots, so that a snapshot is often being written.
set_options() { # MODE
  case $1 in
    sp-explicit) echo --set 'time={end=0.4,scheme="explicit"}' --set output.every=0.01 ;;
    sp-implicit) echo --set 'time={end=4.0,tolerance=2e-4}' ;;
    dp-explicit) echo --set 'time={end=4.0,scheme="explicit",mass_scaling=100.0}' ;;
    dp-implicit) echo --set 'time={end=4.0,step=0.02}' ;;
    *-moving) moving ;;
    sp-failing) ;;
    dp-points) echo --set 'time={end=4.0,scheme="explicit",mass_scaling=100.0}' --set flow.integration=material-point ;;
  esac
  case $1 in dp-*) echo --set formulation=double-point --set points.liquid_per_element=3 ;; esac
}

milliseconds() { local now; now=$(date +%s%N); echo $((now / 1000000)); }

# The facts of the run in run.json; durations and threads differ between any two runs.
account() { grep -vE '"(wall_seconds|seconds|memory_bytes|threads|resumed_at)":' "$1/run.json"; }

same() { # RESULTS
  diff -rq -x .lock -x run.json "$1" whole > differences.txt 2>&1 &&
    diff <(account "$1") <(account whole) >> differences.txt
}

# Reads every snapshot that the series name, and every row.
readable() { # RESULTS
  [ -e "$1/mesh.hdf.series" ] || return 0
  "$programs/suffuse-post" export "$1" -o exported > post.txt 2>&1 &&
    "$programs/suffuse-post" history "$1" >> post.txt 2>&1 &&
    "$programs/suffuse-post" ledger "$1" >> post.txt 2>&1
}

start() { # RESULTS: in the background, where the shell prints no message about a kill
  "$programs/suffuse-solver" kill.case.h5 -o "$1" --quiet --resume --threads $((1 + RANDOM % 2)) \
    --checkpoint-every "$((RANDOM % 2)).05" 2> solver.txt &
  pid=$!
}

# Kills `wanted` times. Adds to done_kills, unreadable, runs, ends; times the undisturbed run.
disturb() { # MODE WANTED
  local wanted=$2 pid begin duration code in_a_row number=0
  rm -rf "${folder:?}/$1"
  mkdir -p "$folder/$1"
  cd "$folder/$1" || exit 1
  local options scene=$scenes/kill.toml
  [ "$1" != sp-failing ] || scene=$scenes/kill-bank.toml
  read -r -a options <<< "$(set_options "$1" | tr '\n' ' ')"
  "$programs/suffuse-mesher" "$scene" "${options[@]}" -o kill.case.h5 > mesher.txt || exit 1
  begin=$(milliseconds)
  "$programs/suffuse-solver" kill.case.h5 -o whole --quiet 2> solver.txt || { cat solver.txt; exit 1; }
  duration=$(($(milliseconds) - begin))
  done_kills=0 unreadable=0 runs=0 resumes=0 ends=0
  while [ "$done_kills" -lt "$wanted" ]; do
    number=$((number + 1))
    local results=run-$number
    for ((in_a_row = 1 + RANDOM % 4; in_a_row > 0; --in_a_row)); do
      [ "$done_kills" -lt "$wanted" ] || break
      start "$results"
      # RANDOM has 15 bits, too few for a moment within a second to less than a millisecond.
      sleep "$(awk -v r="$((RANDOM * 32768 + RANDOM))" -v t="$duration" 'BEGIN { print r / 2^30 * t / 1000 }')"
      kill -9 $pid 2> /dev/null
      wait $pid 2> /dev/null
      code=$?
      [ $code -ne 0 ] || break  # too late: it is done
      if [ $code -ne 137 ]; then
        echo "$1: $results: did not go on (exit code $code):" >&2
        cat solver.txt >&2
        exit 1
      fi
      done_kills=$((done_kills + 1))
      readable "$results" || { unreadable=$((unreadable + 1)); cat post.txt >&2; }
    done
    runs=$((runs + 1))
    if "$programs/suffuse-solver" kill.case.h5 -o "$results" --quiet --resume 2> solver.txt; then
      resumes=$((resumes + 1))
    else
      cat solver.txt >&2
    fi
    if same "$results"; then
      ends=$((ends + 1))
      rm -rf "$results"
    else
      echo "$folder/$1/$results is not as $folder/$1/whole:" >&2
      cat differences.txt >&2
    fi
  done
  seconds=$(awk -v t="$duration" 'BEGIN { print t / 1000 }')
}

table=$folder/kill.csv
echo formulation,scheme,run_seconds,kills,unreadable,runs,clean_resumes,equal_ends > "$table"
wrong=0
for index in "${!modes[@]}"; do
  mode=${modes[index]}
  # The shares of all modes add up to KILLS.
  share=$((kills * (index + 1) / ${#modes[@]} - kills * index / ${#modes[@]}))
  disturb "$mode" "$share" 2> >(grep -v ' Killed ' >&2)
  formulation=single-point
  case $mode in dp-*) formulation=double-point ;; esac
  scheme=${mode#*-}
  [ "$scheme" != points ] || scheme='explicit at material points'
  [ "$scheme" != failing ] || scheme='implicit with soil that fails'
  [ "$scheme" != moving ] || scheme='implicit with soil that moves'
  echo "$formulation,$scheme,$seconds,$done_kills,$unreadable,$runs,$resumes,$ends" >> "$table"
  [ "$unreadable" -eq 0 ] && [ "$resumes" -eq "$runs" ] && [ "$ends" -eq "$runs" ] || wrong=$((wrong + 1))
  rm -rf "$folder/$mode/exported"
done

echo '| formulation | scheme | kills | of these with a snapshot that cannot be read | runs | that went on to the end | with equal files |'
echo '|---|---|---|---|---|---|---|'
sed 1d "$table" | awk -F, '{
  printf "| %s | %s | %d | %d | %d | %d | %d |\n", $1, $2, $4, $5, $6, $7, $8
  for (k = 4; k <= 8; ++k) sum[k] += $k
} END { printf "| all | | %d | %d | %d | %d | %d |\n", sum[4], sum[5], sum[6], sum[7], sum[8] }'
[ $wrong -eq 0 ]

#!/usr/bin/env bash
# Does a sweep through Slurm end with the same table as one by make, also if jobs and daemons of
# jobs are killed? Works on this machine, in a folder of its own; arguments go to make (BIN=FOLDER).
# Skipped if Slurm is missing.
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
work=$scratch
runs=${SLURM_TEST_RUNS:-100}

# sweep OUT ARGUMENT...
sweep() {
  local out=$1
  shift
  make -C "$workflows" sweep SCENE="$work/column.toml" SWEEP="$work/runs.csv" OUT="$work/$out" "$@" "${make_arguments[@]}"
}

# one_solver: prints a solver that works in the folder of the test, and waits for it for some
# seconds.
one_solver() {
  local i pid
  for ((i = 0; i < 50; ++i)); do
    for pid in $(pgrep -x suffuse-solver); do
      case $(readlink "/proc/$pid/cwd" 2> /dev/null) in "$work"/*) echo "$pid"; return ;; esac
    done
    sleep 0.1
  done
  return 1
}

parent() { awk '{ print $4 }' "/proc/$1/stat" 2> /dev/null; }

job_of() { tr '\0' '\n' 2> /dev/null < "/proc/$1/environ" | sed -n 's/^SLURM_JOB_ID=//p' | grep .; }

ended() { find "$work/slurm" -name '0*.status' 2> /dev/null | wc -l; }

# wait_for COUNT: waits until this many runs have ended.
wait_for() {
  local i
  for ((i = 0; i < 1200; ++i)); do
    [ "$(ended)" -lt "$1" ] || return 0
    sleep 0.1
  done
  echo "FAILED: only $(ended) of $1 runs after two minutes"
  exit 1
}

# This part runs within slurm_here.sh.
if [ "${1:-}" = inside ]; then
  work=$2
  shift 2
  make_arguments=("$@")
  sweep slurm -j4 LAUNCH="srun --quiet -n1" > "$work/first.log" 2>&1 & caller=$!
  killed=0
  for ((round = 1; round <= 4; ++round)); do
    wait_for $((runs * round / 10))
    # Kills a run, a job, and the process above run.py that starts a job, after which the job is
    # cancelled.
    ! solver=$(one_solver) || ! kill -9 "$solver" 2> /dev/null || killed=$((killed + 1))
    ! solver=$(one_solver) || ! job=$(job_of "$solver") || ! scancel "$job" || killed=$((killed + 1))
    if solver=$(one_solver) && job=$(job_of "$solver") && above=$(parent "$solver") && above=$(parent "$above") &&
        [ "$(cat "/proc/$above/comm")" = slurmstepd ] && kill -9 "$above"; then
      killed=$((killed + 1))
      scancel "$job" || true
    fi
  done
  # Kills make with the sweep's own processes. Jobs are descendants of slurmd.
  for pid in $(tree $caller); do kill -9 "$pid" 2> /dev/null || true; done
  wait "$caller" 2> /dev/null || true
  echo "killed $killed runs, steps and jobs, and make at $(ended) of $runs runs"
  start=$(date +%s.%N)
  sweep slurm -j4 LAUNCH="srun --quiet -n1" > "$work/second.log" 2>&1 || { cat "$work/second.log"; exit 1; }
  echo "went on with the rest in $(awk -v s="$start" -v e="$(date +%s.%N)" 'BEGIN { printf "%.0f", e - s }') s"
  [ "$killed" -ge 6 ] || { echo "FAILED: too few were killed for a test"; exit 1; }
  exit 0
fi

sed 's/^end *=.*/end = 20.0/' "$workflows/stress/kill.toml" > "$work/column.toml"
printf '%s\n' "runs,$runs" seed,1 key,distribution,mean,deviation,min,max \
  soil.specimen.conductivity,lognormal,2e-2,1e-2,, soil.specimen.erosion.rate,uniform,,,1,8 > "$work/runs.csv"

code=0
"$workflows/sweep/slurm_here.sh" 2 "${BASH_SOURCE[0]}" inside "$work" "${make_arguments[@]}" || code=$?
[ $code -ne 77 ] || exit 0
[ $code -eq 0 ] || { tail -n 20 "$work"/*.log; exit 1; }
sweep local -j2 > "$work/local.log" 2>&1 || { cat "$work/local.log"; exit 1; }
cmp "$work/local/sweep/runs/sweep.csv" "$work/slurm/sweep/runs/sweep.csv" || { echo 'FAILED: the tables differ'; exit 1; }
[ "$(grep -c ,done, "$work/slurm/sweep/runs/sweep.csv")" -eq "$runs" ] || { echo 'FAILED: not all runs are done'; exit 1; }
echo "ok: $runs runs through Slurm, some killed, have the table of make -j2, byte by byte"

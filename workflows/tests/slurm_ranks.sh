#!/usr/bin/env bash
# Does cluster/suffuse.sbatch make the results of the serial program, byte by byte, also if the job's time ends or a
# signal stops it? Works on this machine, in a folder of its own, with a Slurm of its own.
#   slurm_ranks.sh FOLDER_OF_PROGRAMS
# Takes minutes. Skipped if Slurm or suffuse-solver-mpi is missing.
set -euo pipefail

fail() {
  echo "FAILED: $*"
  tail -n 30 ./*.out
  exit 1
}

# submit CODE CASE OPTION OF sbatch...: submits a job, waits for it and expects this exit code.
submit() {
  local expected=$1 name=$2 code=0
  shift 2
  sbatch --wait --quiet --ntasks=2 --output="$name.out" "$@" "$workflows/cluster/suffuse.sbatch" "$name.case.h5" --quiet || code=$?
  [ "$code" -eq "$expected" ] || fail "$name: exit code $code; expected $expected"
}

# expect_same NAME: the results are those of the serial program, but for run.json.
expect_same() {
  grep -q '"status": "done"' "$1.results/run.json" || fail "$1 is not done"
  grep -q '"ranks": 2' "$1.results/run.json" || fail "$1 did not run on two ranks"
  diff -r -x run.json -x .lock "$1.alone" "$1.results" || fail "$1 differs from the serial run"
}

# of_run NAME KEY: prints a value of run.json.
of_run() { sed -n "s/^  \"$2\": \(.*\),\$/\1/p" "$1.results/run.json"; }

# expect_checkpoint NAME: the run was stopped between two snapshots and can go on.
expect_checkpoint() {
  grep -q '"status": "interrupted"' "$1.results/run.json" || fail "$1 was not stopped"
  [ -s "$1.results/checkpoint.hdf" ] || fail "$1 has no checkpoint"
}

# seconds COMMAND...: runs it and prints how long it took.
seconds() {
  local start=$SECONDS
  "$@" >&2
  echo "$((SECONDS - start)) s"
}

# This part runs within slurm_here.sh.
if [ "${1:-}" = inside ]; then
  took=$(seconds submit 0 short --time=10)
  expect_same short
  echo "a job of two tasks has the files of the serial run, after $took"

  took=$(seconds submit 130 long --time=1 --signal=B:USR1@20)
  expect_checkpoint long
  echo "a job of one minute stopped with a checkpoint $took after it was submitted, with exit code 130"
  took=$(seconds submit 0 long --time=20)
  expect_same long
  echo "the job submitted again went on at t = $(of_run long resumed_at) s and has the files of the serial run, after $took"

  rm -r short.results
  job=$(REQUEUE=1 sbatch --parsable --ntasks=2 --time=10 --output=short.out "$workflows/cluster/suffuse.sbatch" short.case.h5 --quiet)
  for ((i = 0; i < 600; ++i)); do [ ! -s short.results/history.csv ] || break; sleep 0.1; done
  sleep 3
  scancel --batch --signal=USR1 "$job"
  stopped=$SECONDS
  # of_job KEY: what Slurm says of the job.
  of_job() { scontrol show job "$job" | sed -n "s/.*$1=\([A-Z0-9]*\).*/\1/p"; }
  for ((i = 0; i < 600; ++i)); do [ "$(of_job Restarts)" != 1 ] || break; sleep 0.1; done
  [ "$(of_job Restarts)" = 1 ] || fail 'the job did not return to the queue'
  expect_checkpoint short
  for ((i = 0; i < 600; ++i)); do [ "$(of_job JobState)" != COMPLETED ] || break; sleep 1; done
  took=$((SECONDS - stopped))
  [ "$(of_job JobState)" = COMPLETED ] || fail "the job that returned to the queue ended as $(of_job JobState)"
  expect_same short
  echo "a job stopped by scancel returned to the queue, went on at t = $(of_run short resumed_at) s and has the files of the serial run, $took s later"
  exit 0
fi

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
script=$workflows/tests/slurm_ranks.sh
PATH=$(cd "$1" && pwd):$PATH
[ -x "$1/suffuse-solver-mpi" ] || { echo 'slurm_ranks.sh: there is no suffuse-solver-mpi, which needs MPI and PETSc; skipped' >&2; exit 0; }
cd "$scratch"
# run_alone NAME END: a case and its serial run. Snapshots are far apart, so that a run goes on from its checkpoint.
run_alone() {
  suffuse-mesher "$workflows/../tests/ranks/scenes/basin.toml" -o "$1.case.h5" --set time.end="$2" \
    --set mesh.size=0.05 --set output.every=0.1 --set output.snapshot_every=2 > mesher.log
  suffuse-solver "$1.case.h5" -o "$1.alone" --quiet 2> alone.log || { cat alone.log; exit 1; }
}
short=4
TIMEFORMAT=%U
cost=$({ time run_alone short $short; } 2>&1)
# Slurm signals a job of one minute with B:USR1@20 after 10 to 40 s. On two ranks the long run takes at least 45 s.
run_alone long "$(awk -v c="$cost" -v s=$short 'BEGIN { print int(90 / c * s) + 1 }')"
# Slurm's daemons need root, and the jobs here are root's. Ranks yield to whatever else runs on the machine.
export workflows OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1
code=0
"$workflows/sweep/slurm_here.sh" 2 "$script" inside || code=$?
[ $code -ne 77 ] || exit 0
[ $code -eq 0 ] || exit 1
echo 'ok: a case on two tasks of Slurm, stopped and resumed, has the bytes of the serial run'

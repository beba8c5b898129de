#!/usr/bin/env bash
# Does a sweep make every run once, report what went wrong, and go on after it was killed? Works in
# a folder of its own, whose name has spaces; arguments go to make (BIN=FOLDER, -j2).
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
cd "$work/my scenes"

# The command of make may have arguments, as it has within `make test`.
export MAKE='make TEST=1'
run_sweep() { run_make sweep SCENE="a column.toml" SWEEP="of rates.csv" "$@"; }

runs_redone() { redone "$out" | grep 'run.json\|status' || true; }

sed 's/^end *=.*/end = 4.0/' "$workflows/stress/kill.toml" > "a column.toml"
cat > "of rates.csv" <<'END'
soil.specimen.erosion.rate,boundary[0].pressure
# the third is wrong
4.0,
2.0,"[[0.0, 2.0e3], [0.2, 4.0e3]]"
-1.0,
1.0,1.0e3
END
out="$work/o ut/sweep/of rates"

run_sweep
expect 'a refused run makes the sweep fail' 2 "$code"
expect 'and the others are made' "$(printf '%s\n' status done done refused done)" "$(column status)"
expect 'every row is in the table, in order' "$(printf '%s\n' run 0001 0002 0003 0004)" "$(column run)"
expect 'values of keys are those of the table' "$(printf '%s\n' soil.specimen.erosion.rate 4.0 2.0 -1.0 1.0)" "$(column soil.specimen.erosion.rate)"
expect 'the message is in the table' \
  '--set soil.specimen.erosion.rate=-1.0: soil.specimen.erosion.rate: got -1.0; expected' \
  "$(grep ^0003 "$out/sweep.csv" | grep -o -- '--set.*expected')"
expect 'and shown, with the count' $'0003 refused: --set soil.specimen.erosion.rate=-1.0\n3 of 4 runs are done' \
  "$(grep -o '^0003 refused: --set[^:]*\|^[0-9]* of 4 runs are done' "$log" | sort)"
expect 'columns: the run, the keys, how it ended, what suffuse-post says of it' \
  'run,soil.specimen.erosion.rate,boundary[0].pressure,status,message,formulation,law,rate' \
  "$(head -1 "$out/sweep.csv" | cut -d, -f1-8)"
expect 'values at the end' "$(printf '%s\n' eroded fines_lost fines_lost_percent water_out flux_out porosity_mean turbidity_max)" \
  "$(head -1 "$out/sweep.csv" | tr , '\n' | sed -n '/^eroded$/,$p')"
expect 'no column of times' '' "$(head -1 "$out/sweep.csv" | tr , '\n' | grep -i 'second\|memory' || true)"
expect 'which are in another' 'run,wall_seconds,memory_bytes' "$(head -1 "$out/cost.csv")"
expect 'figures' "$(printf '%s\n' distribution.png over-soil.specimen.erosion.rate.png over-time.png)" \
  "$(cd "$out" && ls ./*.png | sed 's|./||')"
expect 'a run has its case, results and ledger' "$(printf '%s\n' 0001.case.h5 0001.inputs 0001.ledger.csv 0001.log \
  0001.results 0001.status)" "$(ls "$out/0001")"

before=$(inventory "$out")
cp "$out/sweep.csv" "$work/table"
run_sweep
expect 'a second call says the same' 2 "$code"
expect 'and makes nothing' '' "$(runs_redone)"

sed -i 's/^1.0,/0.5,/' "of rates.csv"
run_sweep
expect 'another row makes that run' "$(printf '%s\n' 0004/0004.results/run.json 0004/0004.status)" "$(runs_redone)"
sed -i 's/^0.5,/1.0,/' "of rates.csv"
run_sweep
expect 'the row as it was, the table as it was' same "$(cmp "$work/table" "$out/sweep.csv" && echo same)"

# Kills make and all its descendants except one solver, which is stopped so that the next call meets
# it.
rm -rf "$out"
run_sweep > /dev/null & caller=$!
orphan=
for ((i = 0; i < 1200 && ${#orphan} == 0; ++i)); do
  sleep 0.01
  for pid in $(pgrep -x suffuse-solver || true); do
    case $(readlink "/proc/$pid/cwd") in "$out"/*) kill -STOP "$pid" && orphan=$pid ;; esac
  done
done
for pid in $(tree "$caller"); do [ "$pid" = "$orphan" ] || kill -9 "$pid" 2> /dev/null || true; done
wait "$caller" 2> /dev/null || true
run_sweep & caller=$!
sleep 2
expect 'a run that another process still makes is waited for' waiting \
  "$(kill -0 "$caller" 2> /dev/null && [ -n "$orphan" ] && [ ! -e "$out/sweep.csv" ] && echo waiting)"
kill -CONT "$orphan" || true
wait "$caller"
expect 'killed and called again, the same table' same "$(cmp "$work/table" "$out/sweep.csv" && echo same)"

rm "$out/0002/0002.status"
sed -i 's/"status": *"done"/"status": "running"/' "$out/0002/0002.results/run.json"
before=$(inventory "$out")
run_sweep
expect 'a run that was stopped goes on alone' "$(printf '%s\n' 0002/0002.results/run.json 0002/0002.status)" "$(runs_redone)"
expect 'from where it stood' '"resumed_at": 4' "$(grep -o '"resumed_at": *[0-9]*' "$out/0002/0002.results/run.json")"

sed -i '/^-1.0/d; /^1.0/d' "of rates.csv"
run_sweep
expect 'without its wrong row the sweep is well' 0 "$code"
expect 'and rows that are gone are not in the table' "$(printf '%s\n' run 0001 0002)" "$(column run)"

printf '%s\n' runs,3 seed,1 key,distribution,mean,deviation,min,max soil.specimen.porosity,uniform,,,0.2,0.4 > sampled.csv
run_make sweep SCENE="a column.toml" SWEEP=sampled.csv NAME="an other"
expect 'runs can be sampled' '0 4 3' \
  "$code $(wc -l < "$work/o ut/sweep/an other/runs.csv") $(grep -c '^000.,0\.[23]' "$work/o ut/sweep/an other/runs.csv")"
run_make sweep SCENE="$workflows/stress/kill.toml" SWEEP=sampled.csv NAME="an other"
expect 'the sweep of another scene is not replaced' '2 1' \
  "$code $(grep -c 'an other: got the runs of .*a column.toml and .*sampled.csv; expected another NAME=' "$log")"
run_make sweep SCENE="a column.toml"
expect 'without a table' 'SWEEP: got nothing; expected a file: make -C workflows TARGET SWEEP=FILE' \
  "$(grep ^SWEEP "$log")"
run_make sweep SCENE=none.toml SWEEP=sampled.csv
expect 'no such scene' "SCENE: got 'none.toml'; there is no such file, seen from $PWD" "$(grep ^SCENE "$log")"
run_make sweep SCENE="a column.toml" SWEEP="of rates.csv" LAUNCH=false NAME=launched
expect 'a scheduler that refuses' "2 $(printf '%s\n' unfinished unfinished)" \
  "$code $(sed 1d "$work/o ut/sweep/launched/sweep.csv" | sed 's/"[^"]*"//g' | cut -d, -f4)"

run_make study SCENE="a column.toml"
expect 'a study of a scene with spaces' "0 $(printf '%s\n' 'a column.case.h5' 'a column.history.csv' 'a column.html' 'a column.inputs' \
  'a column.ledger.csv' 'a column.masses.png' 'a column.masses.svg' 'a column.porosity.png' \
  'a column.porosity.svg' 'a column.results' 'a column.status')" "$code $(ls "$work/o ut/study")"

"$workflows/tests/sampling.py" || failures=$((failures + 1))
finish sweeps

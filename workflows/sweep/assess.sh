#!/usr/bin/env bash
# One run, and how safe it is: run.sh, then the checks of its results and the factor of safety of its
# soil. It goes on where an earlier call was stopped, and does nothing if an earlier call reached an end.
#
#     assess.sh PROGRAMS STEM TOLERANCE FACTOR [OPTION...]
#
# FACTOR says of which states the factor of safety is wanted: start, last, all, or checks for none.
# The options are --region NAME and --deeper DEPTH of the strength reduction. Makes STEM.check.csv and
# STEM.factors.csv where there is something to write, and STEM.assessed at the end: lines
# `check: MESSAGE` and `factor: MESSAGE`, why there is no such number, and `warning: MESSAGE`. Programs
# that were stopped end this script with their exit code, as in run.sh.
set -u
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
programs=$1 stem=$2 tolerance=$3 factor=$4
shift 4
name=${stem##*/}
"$here/run.sh" "$programs" "$stem" "$tolerance" || exit $?
cd "${stem%/*}" || exit 4

exec 9> ".$name.assess.lock"
flock 9
assessed=$name.assessed
if [ "$assessed" -nt "$name.status" ] && [ "$assessed" -nt ../assess.inputs ]; then exit 0; fi

# A table of an earlier state must not stay where the new state has none.
rm -f "$name.check.csv" "$name.factors.csv" "$assessed"
: > "$assessed.new"
trap : INT TERM HUP

# ask WHAT PROGRAM ARGUMENT...: runs a program and keeps its first error, and its warnings.
ask() {
  local what=$1 program=$2 code=0
  shift 2
  "$programs/$program" "$@" > /dev/null 2> ".$name.said" 9>&- || code=$?
  sed -n 's/^.*: warning: /warning: /p' ".$name.said" >> "$assessed.new"
  case $code in
    0) ;;
    2 | 3) echo "$what: $(grep -v ': warning: ' ".$name.said" | grep -m1 .)" >> "$assessed.new" ;;
    *)
      echo "$name stopped with exit code $code of $program"
      exit "$code"
      ;;
  esac
}

if [ -e "$name.results/run.json" ]; then ask check suffuse-post check "$name.results" --csv "$name.check.csv"; fi
if [ "$factor" != checks ] && [ "$(head -1 "$name.status")" != refused ]; then
  state=()
  case $factor in
    last) state=(--state "$name.results") ;;
    all) state=(--state "$name.results" --time all) ;;
  esac
  # A run that failed at its start has no state.
  if [ "$factor" = start ] || [ -e "$name.results/run.json" ]; then
    ask factor suffuse-solver "$name.case.h5" --strength-reduction "${state[@]}" "$@" --quiet -o "$name.factors.csv"
  fi
fi
rm -f ".$name.said"
mv "$assessed.new" "$assessed"

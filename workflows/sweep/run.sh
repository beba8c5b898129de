#!/usr/bin/env bash
# One run: mesh, solve, ledger. It goes on where an earlier call was stopped, and does nothing if an
# earlier call reached an end.
#
#     run.sh PROGRAMS STEM TOLERANCE
#
# PROGRAMS is the folder of the programs. STEM.inputs lists the inputs of the run (inputs.py). Makes
# STEM.case.h5, STEM.results/, STEM.ledger.csv, STEM.log, and STEM.status when the run ends by
# itself: a word, then the messages.
#
#     done        to the end, and every kilogram is accounted for
#     refused     the input is wrong
#     failed      the computation could not go on
#     unbalanced  a residual of the ledger is above TOLERANCE
#
# Then the exit code is 0, whatever the word. Otherwise it is that of the program that was stopped
# or could not use a file, and the next call goes on.
#
# PROGRESS=1 is for a scene of one's own: it shows the messages of the programs instead of keeping them in
# STEM.log. There is a status then only if the run is done; the exit code is 2 if it was refused, and 3 if it
# failed or is unbalanced.
set -u
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
programs=$1 stem=$2 tolerance=$3
case $programs in /*) ;; *) programs=$PWD/$programs ;; esac
name=${stem##*/}
cd "${stem%/*}" || exit 4
# The inputs of the case, to which the results belong.
started=.$name.started

# A program goes on when make above it is killed. Programs inherit the lock, so this waits for them.
exec 9> ".$name.lock"
flock 9
if [ "$name.status" -nt "$name.inputs" ]; then exit 0; fi

exec 3>&1
messages=.$name.messages
: > "$messages"
quiet=()
if [ -z "${PROGRESS:-}" ]; then
  exec > "$name.log" 2>&1
  quiet=(--quiet)
fi
# When a signal stops this script, the solver still writes its checkpoint.
trap : INT TERM HUP

# Saves a process for every run without messages.
show_messages() { [ ! -s "$messages" ] || cat "$messages"; }

# end WORD: writes the status, with the messages of the last program.
end() {
  if [ -n "${PROGRESS:-}" ] && [ "$1" != done ]; then
    rm -f "$name.status"
    [ "$1" = refused ] && exit 2
    exit 3
  fi
  { echo "$1"; show_messages; } > "$name.status.new" && mv "$name.status.new" "$name.status"
  echo "$name $1" >&3
  exit 0
}

# step PROGRAM WORD3 ARGUMENT...: runs a program; exit code 3 ends the run with the status WORD3.
step() {
  local program=$1 word=$2 code=0
  shift 2
  case $program in */*) ;; *) program=$programs/$program ;; esac
  if [ -n "${PROGRESS:-}" ]; then
    "$program" "$@" 3>&- || code=$?
  else
    "$program" "$@" 3>&- 2> "$messages" || code=$?
    show_messages
  fi
  case $code in
    0) return ;;
    2) end refused ;;
    3) end "$word" ;;
  esac
  echo "stopped with exit code $code of ${program##*/}" >> "$messages"
  echo "$name stopped with exit code $code of ${program##*/}" >&3
  exit "$code"
}

if ! { [ -e "$name.case.h5" ] && [ -e "$started" ] && cmp -s "$name.inputs" "$started"; }; then
  changes=()
  while IFS= read -r line; do
    case $line in
      scene\ *) scene=${line#scene } ;;
      set\ *) changes+=(--set "${line#set }") ;;
    esac
  done < "$name.inputs"
  # Until the case is whole, an earlier one fits no inputs.
  rm -f "$started"
  case $(grep '^adapt' "$name.inputs") in
    adapt) step "$here/../adapt.py" failed "$programs" "$scene" "$name" "${changes[@]}" ;;
    adapt*) step "$here/../adapt.py" failed --by-default "$programs" "$scene" "$name" "${changes[@]}" ;;
    *) step suffuse-mesher refused "$scene" "${changes[@]}" -o "$name.case.h5" ;;
  esac
  [ ! -e "$name.results" ] || rm -rf "$name.results" "$name.ledger.csv"
  cp "$name.inputs" "$started"
fi
step suffuse-solver failed "$name.case.h5" -o "$name.results" "${quiet[@]}" --resume
step suffuse-post unbalanced ledger "$name.results" --csv "$name.ledger.csv" --tolerance "$tolerance"
end done

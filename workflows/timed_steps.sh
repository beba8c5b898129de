#!/usr/bin/env bash
# Makes targets one after the other and prints the seconds of each at the end: timed_steps.sh
# TARGET... MAKE is the command of make with its arguments. Ends at the first target that fails.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")"
table='' total=0 status=0
for target in "$@"; do
  begin=$(date +%s)
  ${MAKE:-make} "$target" || status=$?
  seconds=$(($(date +%s) - begin))
  total=$((total + seconds))
  table+=$(printf '%-18s %6d' "$target" "$seconds")$'\n'
  [ "$status" = 0 ] || break
done
printf '\n%-18s %6s\n%s%-18s %6d\n' step seconds "$table" all "$total"
exit "$status"

#!/usr/bin/env bash
# What bash offers behind a command line that ends at the cursor.
#   completion.sh COMPLETION_SCRIPT
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# As bash-completion does: within a function, when the first word is known.
load() { source "$1"; }
load "$(realpath "$1")"
cd "$work"
mkdir weir.results 'my run.results' folder
touch errors weir.toml weir.geo weir.case.h5 known.csv 'my scene.toml'
failures=0

# expect WHAT WORDS WANTED: WORDS are the command line, one per line of the array; the last is at the cursor.
expect() {
  local what=$1 wanted=$2
  shift 2
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  local handler
  handler=$(complete -p "$1" | sed 's/.*-F \([^ ]*\) .*/\1/')
  "$handler" 2> errors || true  # compopt fails where nothing is completed
  ! grep -v compopt errors || failures=$((failures + 1))
  local got
  got=$(printf '%s\n' "${COMPREPLY[@]}" | sort | paste -sd'|')
  if [ "$got" == "$wanted" ]; then
    echo "ok: $what"
  else
    printf 'FAILED: %s: got %s; expected %s\n' "$what" "$got" "$wanted"
    failures=$((failures + 1))
  fi
}

expect 'a scene' 'folder|my run.results|my scene.toml|weir.results|weir.toml' suffuse-mesher ''
expect 'options by their start' '--scene-reference|--set|--sizes' suffuse-mesher weir.toml --s
expect 'any file to write' 'weir.case.h5|weir.geo|weir.results|weir.toml' suffuse-mesher weir.toml -o we
expect 'nothing where nothing is known' '' suffuse-mesher weir.toml --set ''
expect 'a case' 'folder|my run.results|weir.case.h5|weir.results' suffuse-solver ''
expect 'a folder' 'folder|my run.results|weir.results' suffuse-solver weir.case.h5 --output ''
expect 'the same behind =' 'weir.results' suffuse-solver --output = we
expect 'the same directly behind =' 'folder|my run.results|weir.results' suffuse-solver --output =
expect 'options of the solver for several processes' '--resume' suffuse-solver-mpi weir.case.h5 --res
expect 'subcommands' 'render|report' suffuse-post re
expect 'options of a subcommand' '--tolerance' suffuse-post ledger weir.results --to
expect 'options of a group' '--x-range' suffuse-post figure porosity weir.results --x-
expect 'results before other folders' 'my run.results|weir.results' suffuse-post ledger ''
expect 'names of figures' 'masses|model' suffuse-post figure m
expect 'more results' 'my run.results|weir.results' suffuse-post figure masses weir.results weir.results ''
expect 'results behind options with values' 'my run.results|weir.results' suffuse-post figure -o a.png --time = 3 masses ''
expect 'places of fields' 'cell' suffuse-post render weir.results --on c
expect 'tables' 'folder|known.csv|my run.results|weir.results' suffuse-post error weir.results --reference ''
[ "$failures" -eq 0 ]

#!/usr/bin/env bash
# clang-tidy on the sources: tidy.sh BUILD JOBS. BUILD has compile_commands.json.
#
# Most of its time goes into headers, so it looks at the batches of files that are compiled as one.
set -eu
build=$(realpath "$1") jobs=$2
cd "$(dirname "$0")/.."

look() {
  local found
  found=$(clang-tidy -quiet --config-file=.clang-tidy -p "$build" --checks=-bugprone-suspicious-include \
    --extra-arg=-Wno-unknown-warning-option --header-filter='/(mesher|solver|post)/.*\.[ch]pp$' "$1" 2> /dev/null) ||
    { echo "$found"; return 1; }
}
export -f look
export build

sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' "$build/compile_commands.json" |
  grep -E "^($build|$PWD)/(mesher|solver|post)/" | sort -u | xargs -P "$jobs" -I{} bash -c 'look {}'

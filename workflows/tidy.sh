#!/usr/bin/env bash
# clang-tidy on the sources: tidy.sh BUILD JOBS [COMMIT|new]. BUILD has compile_commands.json.
#
# Headers take most of its time, so it checks the batches of files that are compiled as one. With
# COMMIT it checks those that changed since then; with `new` since the branch left main, and on main
# since the previous commit.
set -eu
build=$(realpath "$1") jobs=$2 since=${3:-}
cd "$(dirname "$0")/.."

look() {
  local found
  found=$(clang-tidy -quiet --config-file=.clang-tidy -p "$build" --checks=-bugprone-suspicious-include \
    --extra-arg=-Wno-unknown-warning-option --header-filter='/(mesher|solver|post)/.*\.[ch]pp$' "$1" 2> /dev/null) ||
    { echo "$found"; return 1; }
}
export -f look
export build

if [ "$since" == new ]; then
  since=''
  for main in origin/main main; do
    since=$(git merge-base HEAD "$main" 2> /dev/null) && break
  done
  [ "$since" != "$(git rev-parse HEAD 2> /dev/null)" ] || since=HEAD^
fi
workflows/tidy_batches.py "$build" "$since" | xargs -r -P "$jobs" -I{} bash -c 'look {}'

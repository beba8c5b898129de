#!/usr/bin/env bash
# clang-tidy on the sources: tidy.sh BUILD JOBS. BUILD has compile_commands.json.
#
# Most of its time goes into the headers, so several files of a folder are looked at together, each for the
# first time. What is found, or keeps files from being read together (names of the same kind in anonymous
# namespaces), is then looked for file by file; only that is shown and counts.
set -eu
build=$(realpath "$1") jobs=$2
cd "$(dirname "$0")/.."
batch_size=10
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# flags_of FILE: as the compiler gets them, one per line.
flags_of() {
  local command
  command=$(grep -F " -c $PWD/$1\"" "$build/compile_commands.json" | head -n 1 |
    sed 's/^ *"command": "//; s/",\{0,1\}$//; s/\\"/"/g; s/\\\\/\\/g; s/ -o [^ ]* -c .*//; s/^[^-]* -/-/')
  # What tidy does not find is the compiler's to warn of.
  eval "printf '%s\n' $command" | grep -v '^-W'
}

for folder in $(find mesher solver post -name '*.cpp' -printf '%h\n' | sort -u); do
  stem=$work/${folder//\//-}
  files=$(find "$folder" -maxdepth 1 -name '*.cpp' | sort)
  batches=$((($(wc -l <<< "$files") + batch_size - 1) / batch_size))
  # Neighbours in the alphabet do alike things with like names.
  split -d -a 3 -n "r/$batches" - "$stem." <<< "$files"
  flags_of "$({ grep -v main.cpp <<< "$files" || echo "$files"; } | head -n 1)" > "$stem-flags"
  for batch in "$stem".*; do
    sed "s|.*|#include \"$PWD/&\"|" "$batch" > "$batch-all.cpp"
    { cat "$stem-flags"; echo '-DSUFFUSE_VERSION="any"'; } > "$batch-flags"
  done
done

look() {
  local batch=$1
  mapfile -t flags < "$batch-flags"
  clang-tidy -quiet --config-file=.clang-tidy --checks=-bugprone-suspicious-include \
    --header-filter='/(mesher|solver|post)/.*\.[ch]pp$' "$batch-all.cpp" -- "${flags[@]}" \
    > /dev/null 2>&1 && return
  local status=0
  while read -r file; do
    clang-tidy -quiet -p "$build" --extra-arg=-Wno-unknown-warning-option "$file" 2> /dev/null || status=1
  done < "$batch"
  return "$status"
}
export -f look
export build

find "$work" -name '*.[0-9][0-9][0-9]' | xargs -P "$jobs" -I{} bash -c 'look {}'

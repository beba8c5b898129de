#!/usr/bin/env bash
# Do killed runs end with the same files as undisturbed ones? Makes a few kills; `make kill` makes
# more. KILLS=N: their number. Arguments go to make (BIN=FOLDER).
set -euo pipefail

workflows=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
before=$(cksum < "$workflows/../docs/evidence/stability.md")
make -C "$workflows" "$@" kill KILLS="${KILLS:-10}" OUT="$work/out"
[ "$before" == "$(cksum < "$workflows/../docs/evidence/stability.md")" ] ||
  { echo "FAILED: a few kills have changed docs/evidence/stability.md"; exit 1; }

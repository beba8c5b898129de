#!/bin/bash
# Puts the tables between the marks of docs/evidence/stability.md and the chart into the folder: document.sh
# PROGRAM OUT DOCS
set -eu -o pipefail
program=$1 out=$2 docs=$3
here=$(cd "$(dirname "$0")" && pwd)
"$program" --list > "$out/sweeps.csv"
cp "$out/stress.png" "$docs/images/stress.png"
{
  echo
  awk -F, -v form=markdown -v what="$out/sweeps.csv" -f "$here/report.awk" "$out/stress.csv"
} | "$here/../between_marks.sh" stress "$docs/evidence/stability.md"

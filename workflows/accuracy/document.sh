#!/bin/bash
# Puts the results between the marks of the document and the charts into its folder: document.sh OUT
# DOCS
set -eu -o pipefail
out=$1 docs=$2
here=$(cd "$(dirname "$0")" && pwd)
for chart in "$out"/*.png; do
  cp "$chart" "$docs/images/accuracy-$(basename "$chart")"
done
{
  echo
  awk -F, -v form=markdown -f "$here/report.awk" "$out/accuracy.csv" "$out/left-out.csv"
} | "$here/../between_marks.sh" results "$docs/evidence/accuracy.md"

#!/bin/bash
# Draws the pictures of the study and puts its table between the marks of the document: document.sh
# PROGRAMS OUT DOCS
set -eu -o pipefail
programs=$1 out=$2 docs=$3
here=$(cd "$(dirname "$0")" && pwd)
"$here/chart.py" "$out/meshes.csv" "$docs/images/adapted-error.svg" sheet-pile pile-over-clay disc
run=$out/pile-over-clay/adapted-0.01/pile-over-clay
"$programs/suffuse-solver" "$run.case.h5" -o "$run.results" --force --quiet
"$programs/suffuse-post" render "$run.results" --field error --log -o "$docs/images/adapted-mesh.png" > /dev/null
{
  echo
  cat "$out/table.md"
  echo
} | "$here/../between_marks.sh" adapted "$docs/evidence/accuracy.md"

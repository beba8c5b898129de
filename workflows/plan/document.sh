#!/bin/bash
# Puts the table of plan.csv between the marks of a document: document.sh PLAN.csv DOCUMENT.md
set -eu -o pipefail
here=$(dirname "$0")
{ awk -F, -v form=markdown -f "$here/report.awk" "$1" || true; } | "$here/../between_marks.sh" table "$2"

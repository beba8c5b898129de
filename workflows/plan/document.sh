#!/bin/bash
# Puts the table of plan.csv between the marks of a document: document.sh PLAN.csv DOCUMENT.md
set -eu -o pipefail
table=$(awk -F, -v form=markdown -f "$(dirname "$0")/report.awk" "$1") || true
TABLE=$table awk '
  /<!-- end of table -->/ { inside = 0 }
  !inside { print }
  /<!-- table: / { print ENVIRON["TABLE"]; inside = 1 }
' "$2" > "$2.tmp"
mv "$2.tmp" "$2"

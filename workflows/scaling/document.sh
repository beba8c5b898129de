#!/bin/bash
# Puts the tables of report.awk between the marks of a document: document.sh TABLES.md DOCUMENT.md
set -eu -o pipefail
TABLES=$(cat "$1") awk '
  /<!-- end of scaling -->/ { inside = 0 }
  !inside { print }
  /<!-- scaling: / { print ENVIRON["TABLES"]; inside = 1 }
' "$2" > "$2.tmp"
mv "$2.tmp" "$2"

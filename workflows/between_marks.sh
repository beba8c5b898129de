#!/bin/bash
# Puts its input between <!-- NAME: ... --> and <!-- end of NAME --> of a document: between_marks.sh
# NAME DOCUMENT.md
set -eu -o pipefail
text=$(cat; echo .)  # the shell drops empty lines at the end
TEXT=${text%.} NAME=$1 awk '
  $0 ~ "<!-- end of " ENVIRON["NAME"] " -->" { inside = 0 }
  !inside { print }
  $0 ~ "<!-- " ENVIRON["NAME"] ": " { printf "%s", ENVIRON["TEXT"]; inside = 1 }
' "$2" > "$2.tmp"
mv "$2.tmp" "$2"

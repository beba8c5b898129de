#!/usr/bin/env bash
# The manual pages: no warnings, all sections, and nothing that --help says is missing.
#   manual_pages.sh FOLDER_OF_PAGES FOLDER_OF_PROGRAMS SOURCE
set -euo pipefail
pages=$1 bin=$2 source=$3
fail() {
  echo "FAILED: $*"
  exit 1
}
command -v groff > /dev/null || { echo 'skipped: groff is missing; apt-get install groff-base'; exit 77; }

# The page of $program as text, in lines of any length.
text() { groff -man -Tutf8 -P-cbou -rLL=1000n "$pages/$program.1"; }

for program in suffuse-mesher suffuse-solver suffuse-post; do
  warnings=$(groff -man -ww -z "$pages/$program.1" 2>&1)
  [ -z "$warnings" ] || fail "$warnings"
  ! command -v mandoc > /dev/null || mandoc -Tlint -W warning "$pages/$program.1" || fail "mandoc of $program"
  ! grep -n '@[A-Z_]*@' "$pages/$program.1" || fail "$program: a placeholder is left"
  sections=$(grep -c '^\(NAME\|SYNOPSIS\|DESCRIPTION\|OPTIONS\|EXIT STATUS\|FILES\|EXAMPLES\|SEE ALSO\)$' <(text))
  [ "$sections" = 8 ] || fail "$program: has $sections of the eight sections"
  for subcommand in '' $("$bin/$program" --help | sed -n '/^Subcommands:/,$s/^  \([a-z-]*\) .*/\1/p'); do
    heading=$([ -z "$subcommand" ] && echo '.SH OPTIONS' || echo ".SS $program $subcommand")
    said=$(sed 's/\\-/-/g' "$pages/$program.1" | awk -v heading="$heading" '/^\.S/ { inside = $0 == heading } inside')
    # shellcheck disable=SC2086  # an empty one is no argument
    for option in $("$bin/$program" $subcommand --help | sed -n 's/^ *\(-[a-z],\)\?\(--[a-z-]*\).*/\2/p'); do
      [[ $subcommand && $option == --help || $said == *"\fB$option\fR"* ]] || fail "$program $subcommand: $option is missing"
    done
  done
done

# Exit codes are those of the programs.
codes=$(sed -n '/enum class ExitCode/,/^}/s/.*= \([0-9]*\).*/\1/p' "$source/mesher/common/errors.hpp" | sort -n)
said=$(sed -n 's/^\.B \([0-9]*\)$/\1/p' "$source/docs/man/exit-status.man" | sort -n)
[ "$codes" = "$said" ] || fail "exit codes: got $said; expected $codes"
echo ok

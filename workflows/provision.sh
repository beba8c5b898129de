#!/usr/bin/env bash
# Installs the missing Debian packages of packages.txt. If none is missing, it changes nothing and
# needs no rights.
#
#   provision.sh           install what is missing
#   provision.sh GROUP     the same for the packages that packages.txt lists for this group alone
#   provision.sh --check   only name what is missing; exit 1 when something is
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
packages_file=$here/packages.txt

fail() {
  printf 'provision.sh: %s\n' "$@" >&2
  exit 1
}

listed() { sed -e 's/#.*//' -e 's/[[:space:]]*$//' -e '/^$/d' "$packages_file"; }

if [ $# -eq 0 ] || [ "$*" = --check ]; then
  mapfile -t packages < <(listed | grep -v :)
else
  mapfile -t packages < <(listed | sed -n "s/^${*//[!a-z-]/}: *//p")
  [ ${#packages[@]} -gt 0 ] || fail "got '$*'; expected --check, a group of packages.txt, or nothing"
fi

command -v dpkg-query >/dev/null ||
  fail "this is not a Debian system (no dpkg-query). Install the equivalents of:" "${packages[*]}"

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${Status}' "$package" 2>/dev/null || true)
  [ "$status" = 'install ok installed' ] || missing+=("$package")
done

if [ ${#missing[@]} -eq 0 ]; then
  exit 0
fi
if [ "${1:-}" = --check ]; then
  fail "missing: ${missing[*]}"
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null ||
    fail "packages are missing, and there is neither root nor sudo to install them. Ask for:" \
      "apt-get install --no-install-recommends ${missing[*]}"
  # Without a terminal nobody can type a password: it fails at once instead of waiting.
  if [ -t 0 ]; then as_root=(sudo); else as_root=(sudo -n); fi
fi

echo "Installing: ${missing[*]}"
# The lists may be old or absent; packages named in them are then not found.
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update --quiet --quiet
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes --quiet --no-install-recommends "${missing[@]}" ||
  fail "apt-get could not install: ${missing[*]}"

#!/usr/bin/env bash
# Tests the Debian packages on a bare Debian 12, in a folder of its own: apt installs them, the
# commands of the first run are run, a case is run on two ranks with suffuse-mpi, and they are removed
# without a trace; then lintian checks them, and a program is built with suffuse-dev.
#   package.sh FOLDER     FOLDER has the packages; the base system and what apt downloads are kept there for the next time
# Needs root and debootstrap. MIRROR=URL: where Debian is; LINTIAN= leaves lintian out.
set -euo pipefail

folder=$(cd "$1" && pwd)
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
MIRROR=${MIRROR:-http://deb.debian.org/debian}
cache=$folder/cache
skip() {
  echo "test-package: skipped: $*"
  exit 0
}
[ "$(id -u)" = 0 ] || skip 'it needs root, for chroot'
command -v debootstrap > /dev/null || skip 'debootstrap is missing: apt-get install debootstrap'
fail() {
  echo "FAILED: $*" >&2
  exit 1
}

mkdir -p "$cache/archives"
root=$(mktemp -d)
trap 'rm -rf --one-file-system "$root"' EXIT
if [ ! -e "$cache/debian-12.tar" ]; then
  echo 'A bare Debian 12, by debootstrap'
  debootstrap --variant=minbase --include=man-db bookworm "$root" "$MIRROR" > "$cache/debootstrap.log" ||
    { tail "$cache/debootstrap.log"; fail debootstrap; }
  tar -C "$root" -cf "$cache/part" . && mv "$cache/part" "$cache/debian-12.tar"
else
  tar -C "$root" -xf "$cache/debian-12.tar"
fi
chmod 755 "$root"  # the root of a system, not a private folder
# The new system reaches the network by the proxy of this machine's apt.
apt-config dump Acquire::http > "$root/etc/apt/apt.conf.d/90-of-the-host"
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
cp "$cache"/archives/*.deb "$root/var/cache/apt/archives/" 2> /dev/null || true
mkdir "$root/srv/suffuse"
cp "$folder"/suffuse*.deb "$source/docs/use/first-run.md" "$root/srv/suffuse/"
cp -r "$source/tests/install/consumer" "$source/tests/ranks/scenes" "$root/srv/suffuse/"

# What commands in the new system can use: apt, silent unless it fails, and files, which prints all files of folders but those of apt and dpkg.
prelude='cd /srv/suffuse
apt() { apt-get -qq --yes --no-install-recommends "$@" > log 2>&1 < /dev/null || { tail -20 log; return 1; }; }
files() { find "${@:-/}" -xdev \( -path /proc -o -path /srv -o -path /var/cache -o -path /var/log -o -path /var/lib/apt -o -path /var/lib/dpkg \
  -o -path /tmp \) -prune -o -print | sort; }'

# inside WHAT: runs bash commands from stdin in the new system, and keeps what apt downloads there.
inside() {
  local status=0
  { echo "$prelude"; cat; } | unshare --mount --pid --fork -- bash -c 'mount -t proc proc "$1/proc" && exec chroot "$1" \
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 LINTIAN="$2" bash -eu -o pipefail' \
    _ "$root" "${LINTIAN-lintian}" || status=$?
  cp -n "$root"/var/cache/apt/archives/*.deb "$cache/archives/" 2> /dev/null || true
  [ "$status" = 0 ] || fail "$1"
}

inside installing <<'E2'
apt update
# Dependencies are installed first, so that files left behind can only be the package's own.
apt satisfy "$(dpkg-deb -f suffuse_*.deb Depends)"
files > before
apt install ./suffuse_*.deb
echo "installed: $(dpkg -L suffuse | grep -c .) files of $(dpkg-query -Wf '${Installed-Size}' suffuse) kB, beside $(dpkg-query -W | wc -l) packages"

mkdir run && cd run
cp /usr/share/doc/suffuse/examples/weir/* .
chown -R 1000 .
# Every command of the page "first run", figures included.
awk '/^    suffuse-/ || more { print substr($0, 5); more = /\\$/ }' ../first-run.md > commands.sh
[ "$(grep -c '^suffuse-' commands.sh)" -ge 15 ]
# The commands run as an ordinary user: libraries keep caches and settings in HOME.
HOME=$PWD setpriv --reuid 1000 --regid 1000 --clear-groups bash -eux commands.sh > output 2>&1 || { cat output; exit 1; }
for picture in porosity.png masses.svg curves.png model.png head.png flownet.png concentration.png profile.png; do
  [ "$(stat -c %s $picture)" -gt 5000 ] || { echo "$picture is empty"; exit 1; }
done
grep -q 'status.*done' weir.results/run.json
echo "the first run: $(grep -c '^suffuse-' commands.sh) commands, $(ls *.png *.svg | wc -l) pictures"
cd ..
for program in mesher solver post; do
  man suffuse-$program > page 2> warnings
  [ "$(wc -l < page)" -gt 60 ] && [ ! -s warnings ] || { cat page warnings; exit 1; }
done
man suffuse-solver | grep -q -- '--checkpoint-every'
echo 'manual pages are read'
python3 -c 'import suffuse' 2> page || grep -q 'No module named' page  # numpy is only recommended

# VTK has libraries of MPI. What starts processes, and PETSc, come with suffuse-mpi.
{ dpkg-deb -f suffuse_*.deb Depends; dpkg-query -Wf '${Package}\n'; } | grep -E '(^| )(openmpi-bin|libpetsc.*)$|, libopenmpi' &&
  { echo 'suffuse needs these'; exit 1; }
apt purge suffuse
files > after
diff before after || { echo 'the package left these behind, or took them away'; exit 1; }
echo 'removed: nothing is left'
E2

# Where PETSc is missing, suffuse-mpi is not made.
if compgen -G "$folder/suffuse-mpi_*.deb" > /dev/null; then
  inside suffuse-mpi <<'E2'
apt install ./suffuse_*.deb
mkdir ranks && cd ranks
suffuse-mesher ../scenes/basin.toml -o basin.case.h5 > log
suffuse-solver basin.case.h5 -o alone --quiet 2> log
code=0
suffuse-solver basin.case.h5 -o shared --ranks 2 2> log || code=$?
{ [ $code = 4 ] && grep -q 'install the package suffuse-mpi' log; } || { cat log; exit 1; }
chown -R 1000 .
cd ..
apt satisfy "$(dpkg-deb -f suffuse-mpi_*.deb Depends)"
files /etc /usr /var/lib > before-mpi
apt install ./suffuse-mpi_*.deb
cd ranks
HOME=$PWD setpriv --reuid 1000 --regid 1000 --clear-groups suffuse-solver basin.case.h5 -o shared --ranks 2 --quiet 2> log || { cat log; exit 1; }
grep -q '"ranks": 2' shared/run.json
diff -r -x run.json -x .lock alone shared
man suffuse-solver-mpi > page 2> warnings
{ grep -q -- '--checkpoint-every' page && [ ! -s warnings ]; } || { cat page warnings; exit 1; }
echo "suffuse-mpi: --ranks 2 has the files of one process; beside $(dpkg-query -W | wc -l) packages"
cd ..
apt purge suffuse-mpi
files /etc /usr /var/lib | diff before-mpi - || { echo 'suffuse-mpi left these behind, or took them away'; exit 1; }
E2
fi

inside 'the packages for others' <<'E2'
apt install ./suffuse_*.deb ./suffuse-dev_*.deb cmake g++ make python3-h5py
python3 -c 'import suffuse; print("suffuse.py:", suffuse.open("run/weir.results"))'
cmake -S consumer -B build > log && cmake --build build >> log || { cat log; exit 1; }
echo "a program with find_package(Suffuse): $(build/consumer run/weir.results)"
if [ -n "$LINTIAN" ]; then
  apt install lintian
  lintian --fail-on error suffuse*.deb && echo 'lintian: no errors'
fi
E2

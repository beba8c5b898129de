#!/usr/bin/env bash
# What `cmake --install` puts into a prefix of its own, and whether it works from there: programs, examples, links of
# the documents, and a program of somebody else that uses find_package(Suffuse).
#   installed_files.sh BUILD SOURCE HAS_MPI      HAS_MPI is 1 where the build has suffuse-solver-mpi, or 0
set -euo pipefail
build=$1 source=$2 has_mpi=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix
fail() {
  echo "FAILED: $*"
  exit 1
}

cmake --install "$build" --prefix "$prefix" > "$work/log" || { cat "$work/log"; fail "cmake --install"; }
cd "$work"

programs=$(cd "$prefix/bin" && echo *)
expected='suffuse-mesher suffuse-post suffuse-solver'
texts=
if [ "$has_mpi" = 1 ]; then
  expected+=' suffuse-solver-mpi'
  texts='share/man/man1/suffuse-solver-mpi.1 share/bash-completion/completions/suffuse-solver-mpi
    share/suffuse/suffuse.sbatch'
fi
[ "$programs" = "$expected" ] || fail "bin/ has: $programs; expected: $expected"
for file in $texts share/man/man1/suffuse-post.1 share/bash-completion/completions/suffuse-solver \
    share/suffuse/show_results.py share/suffuse/python/suffuse.py share/doc/suffuse/LICENSE \
    share/doc/suffuse/examples/levee/flood.toml share/doc/suffuse/workflows/paper/sp-consistent.toml; do
  [ -s "$prefix/$file" ] || fail "$file is missing"
done
# Installed files contain no path of the machine that built them, except in assertions of libraries.
grep -rIl -- "$source" "$prefix" && fail 'these name the folder of the sources'

doc=$prefix/share/doc/suffuse
while read -r page; do
  # shellcheck disable=SC2013  # no link has spaces
  for link in $(grep -o '](\([A-Za-z.-]*/\)*[A-Za-z-]*\.md' "$page" | sed 's/^](//'); do
    [ -e "$(dirname "$page")/$link" ] || fail "$page: $link is missing"
  done
done < <(find "$doc" -name '*.md')

cp "$doc"/examples/weir/* .
"$prefix/bin/suffuse-mesher" weir.toml --set time.end=2 > /dev/null
"$prefix/bin/suffuse-solver" weir.case.h5 --quiet
"$prefix/bin/suffuse-post" ledger weir.results --tolerance 1e-12 > /dev/null
if [ -n "$texts" ]; then
  "$prefix/bin/suffuse-solver" weir.case.h5 -o shared.results --ranks 2 --quiet
  grep -q '"ranks": 2' shared.results/run.json || fail '--ranks 2 did not run on two ranks'
  rm "$prefix/bin/suffuse-solver-mpi"
fi
code=0
"$prefix/bin/suffuse-solver" weir.case.h5 --ranks 2 2> said || code=$?
{ [ "$code" -eq 4 ] && grep -q "no suffuse-solver-mpi in $prefix/bin,.*suffuse-mpi" said; } || fail "--ranks without suffuse-solver-mpi: $code, $(cat said)"
for scene in "$doc"/workflows/*/*.toml "$doc"/examples/*/*.toml; do
  "$prefix/bin/suffuse-mesher" "$scene" -o other.case.h5 > /dev/null || fail "$scene"
done

PYTHONPATH=$prefix/share/suffuse/python /usr/bin/python3 -c 'import suffuse; print(len(suffuse.open("weir.results").times))' \
  2> python.log || grep -q "No module named '\(numpy\|h5py\)" python.log || fail "$(cat python.log)"

cmake -S "$source/tests/install/consumer" -B consumer -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release > log &&
  cmake --build consumer >> log || { cat log; fail 'a program with find_package(Suffuse)'; }
said=$(consumer/consumer weir.results)
wanted="$("$prefix/bin/suffuse-post" table weir.results --csv runs.csv && awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^elements/) c = i }
  NR == 2 { print $c }' runs.csv) elements, 2 s,"
[[ $said == "$wanted "* ]] || fail "the program says '$said', suffuse-post '$wanted'"
echo "ok: $said"

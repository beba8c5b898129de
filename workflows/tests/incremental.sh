#!/usr/bin/env bash
# Does make redo what it must and nothing else? Works on a copy of the paper's scenes with short runs, in
# a folder of its own; arguments go to make (BIN=FOLDER, -j2).
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
work=$scratch out=$scratch/out

# make_well TARGET VARIABLE...: make in folders whose names have no spaces; fails unless it ends well.
make_well() {
  run_make "$@" OUT="$out" PAPER="$work/paper"
  [ "$code" -eq 0 ] || { cat "$log"; echo "FAILED: make $*"; exit 1; }
}

# Everything made from one run, and from one scene, except the insides of its results folder.
made_by_run() { printf '%s\n' "$1".{case.h5,inputs,status} "$1".{history,ledger}.csv "$1".results/run.json; }
made_from() { made_by_run "$1"; printf '%s\n' "$1".{porosity,masses}.{png,svg}; }

# insides_removed: the list on standard input without the insides of results folders.
insides_removed() { grep -v '\.results/[^r]\|\.results/regions'; }

# expect_redone WHAT FILES TARGET VARIABLE...: make makes these files, insides of results folders left out, and no others.
expect_redone() {
  before=$(inventory "$out")
  make_well "${@:3}"
  expect "$1" "$(sort <<< "$2")" "$(if [ -n "$2" ]; then redone "$out" | insides_removed | sort; else redone "$out"; fi)"
}

mkdir -p "$work/paper" "$out"
cp "$workflows/paper/paper-says.csv" "$work/paper"
for scene in "$workflows"/paper/*.toml; do
  sed 's/^end .*/end = 2.0/' "$scene" > "$work/paper/$(basename "$scene")"
done
sed 's/end=120.0/end=2.0/' "$workflows/paper/variants.mk" > "$work/paper/variants.mk"
variants=(dp-paper-{12,6,3,1} dp-default-{3,1} dp-no-mass-scaling)

tables=$(printf 'paper/%s.csv\n' runs paper)
of_laws=$(printf 'paper/%s\n' {fig4-porosity,fig7-masses}.{png,svg})
of_variants=$(printf 'paper/%s\n' {fig5-solid-mass,fig6-empty-elements,mass-scaling-flux}.{png,svg})
others=$(printf 'paper/%s\n' fig2-model-sp.png fig3-model-dp.png {sp-dp-comparison,implicit-comparison}.{png,svg})
made_by_variants=$(for name in "${variants[@]}"; do made_by_run "paper/$name"; done)
of_scenes=$(for scene in "$work"/paper/*.toml; do made_from "paper/$(basename "$scene" .toml)"; done)
expect_redone 'paper makes every figure, table and result' \
  "$(printf '%s\n' "$tables" "$of_laws" "$of_variants" "$others" "$made_by_variants" "$of_scenes")" paper
expect_redone 'a second call makes nothing' '' paper

touch "$work/paper/sp-logarithmic.toml" "$work/paper/variants.mk"
expect_redone 'nor does one after files were touched' '' paper

echo '# another text' >> "$work/paper/sp-logarithmic.toml"
expect_redone 'a change of one scene makes its own files and the figures it is in, and no others' \
  "$(made_from paper/sp-logarithmic; printf '%s\n' "$of_laws" "$tables")" paper

sed -i 's/end=2.0/end=2.5/' "$work/paper/variants.mk"
expect_redone 'a change of one variant makes it, its figure and the tables, and no others' \
  "$(made_by_run paper/dp-no-mass-scaling; printf '%s\n' paper/mass-scaling-flux.{png,svg} "$tables")" paper

touch "$work/paper/paper-says.csv"
expect_redone 'touching what the paper says makes the table of it, alone' paper/paper.csv paper

before=$(inventory "$out")
rm "$out/paper/sp-constant-table.status"
sed -i 's/"status": *"done"/"status": "running"/' "$out/paper/sp-constant-table.results/run.json"
make_well paper
expect 'a run that did not finish is taken up' paper/sp-constant-table.results/run.json "$(redone "$out" | grep run.json)"
expect 'and goes on from its last snapshot' 'going on from t = 2' "$(grep -o 'going on from t = [0-9]*' "$log")"

rm "$out/paper/sp-constant-figure.masses.svg"
expect_redone 'a figure removed is drawn again, alone' paper/sp-constant-figure.masses.svg paper

mkdir "$work/elsewhere"
cp "$work/paper/sp-logarithmic.toml" "$work/elsewhere/mine.toml"
cd "$work/elsewhere"
expect_redone 'study works on a scene elsewhere' "$(made_from study/mine; echo study/mine.html)" study SCENE=mine.toml
expect_redone 'a second study of the same scene makes nothing' '' study SCENE="$work/elsewhere/mine.toml"

before=$(inventory "$out")
mkdir "$work/another"
cp "$work/elsewhere/mine.toml" "$work/another/mine.toml"
touch --date=yesterday "$work/another/mine.toml"
make_well study SCENE="$work/another/mine.toml"
expect 'another scene of the same name is not taken for the first' study/mine.results/run.json "$(redone "$out" | grep run.json)"

sed -i 's/^porosity .*/porosity = 1.3/' "$work/another/mine.toml"
before=$(inventory "$out")
run_make study SCENE="$work/another/mine.toml" OUT="$out"
expect 'a wrong scene stops make' 2 "$code"
expect 'and leaves what stood there' '' "$(redone "$out" | grep -v '\.inputs$\|\.log$\|\.status$')"

finish 'what make redoes'

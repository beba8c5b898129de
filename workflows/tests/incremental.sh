#!/usr/bin/env bash
# Does make redo what it must and nothing else? Works on a copy of the paper's scenes with short runs, in
# a folder of its own; arguments go to make (BIN=FOLDER, -j2).
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
work=$scratch

run_make() {
  make -C "$workflows" "${make_arguments[@]}" OUT="$work/out" PAPER="$work/paper" "$@" \
    > "$log" 2>&1 || { cat "$log"; echo "FAILED: make $*"; exit 1; }
}

# Paths, times (to the nanosecond) and sizes of all files made so far. Hidden files are notes of
# make.
inventory() { find "$work/out" -type f -not -name '.*' -printf '%P %T@ %s\n' | sort; }

# redone BEFORE: the files whose line is not in BEFORE, one per line, by path below out/.
redone() { comm -13 "$1" <(inventory) | cut -d' ' -f1; }

# Everything made from one run, and from one scene, except the insides of its results folder.
made_by_run() { printf '%s\n' "$1".{case.h5,inputs,status} "$1".{history,ledger}.csv "$1".results/run.json; }
made_from() { made_by_run "$1"; printf '%s\n' "$1".{porosity,masses}.{png,svg}; }

# insides_removed: the list on standard input without the insides of results folders.
insides_removed() { grep -v '\.results/[^r]\|\.results/regions'; }

mkdir "$work/paper"
cp "$workflows/paper/paper-says.csv" "$work/paper"
for scene in "$workflows"/paper/*.toml; do
  sed 's/^end .*/end = 4.0/' "$scene" > "$work/paper/$(basename "$scene")"
done
sed 's/end=120.0/end=4.0/' "$workflows/paper/variants.mk" > "$work/paper/variants.mk"
variants=(dp-paper-{12,6,3,1} dp-default-{3,1} dp-no-mass-scaling)

run_make paper
tables=$(printf 'paper/%s.csv\n' runs paper)
of_laws=$(printf 'paper/%s\n' {fig4-porosity,fig7-masses}.{png,svg})
of_variants=$(printf 'paper/%s\n' {fig5-solid-mass,fig6-empty-elements,mass-scaling-flux}.{png,svg})
others=$(printf 'paper/%s\n' fig2-model-sp.png fig3-model-dp.png {sp-dp-comparison,implicit-comparison}.{png,svg})
made_by_variants=$(for name in "${variants[@]}"; do made_by_run "paper/$name"; done)
expected=$({ echo "$tables"; echo "$of_laws"; echo "$of_variants"; echo "$others"; echo "$made_by_variants"
  for scene in "$work"/paper/*.toml; do made_from "paper/$(basename "$scene" .toml)"; done; } | sort)
expect 'paper makes every figure, table and result' "$expected" \
  "$(inventory | cut -d' ' -f1 | insides_removed | sort)"

inventory > "$work/before"
run_make paper
expect 'a second call makes nothing' '' "$(redone "$work/before")"

touch "$work/paper/sp-logarithmic.toml" "$work/paper/variants.mk"
run_make paper
expect 'nor does one after files were touched' '' "$(redone "$work/before")"

echo '# another text' >> "$work/paper/sp-logarithmic.toml"
inventory > "$work/before"
run_make paper
expect 'a change of one scene makes its own files and the figures it is in, and no others' \
  "$({ made_from paper/sp-logarithmic; echo "$of_laws"; echo "$tables"; } | sort)" \
  "$(redone "$work/before" | insides_removed | sort)"

sed -i 's/end=4.0/end=4.5/' "$work/paper/variants.mk"
inventory > "$work/before"
run_make paper
expect 'a change of one variant makes it, its figure and the tables, and no others' \
  "$({ made_by_run paper/dp-no-mass-scaling; printf '%s\n' paper/mass-scaling-flux.{png,svg} "$tables"; } | sort)" \
  "$(redone "$work/before" | insides_removed | sort)"

touch "$work/paper/paper-says.csv"
inventory > "$work/before"
run_make paper
expect 'touching what the paper says makes the table of it, alone' paper/paper.csv \
  "$(redone "$work/before")"

inventory > "$work/before"
rm "$work/out/paper/sp-constant-table.status"
sed -i 's/"status": *"done"/"status": "running"/' "$work/out/paper/sp-constant-table.results/run.json"
run_make paper
expect 'a run that did not finish is taken up' paper/sp-constant-table.results/run.json \
  "$(redone "$work/before" | grep run.json)"
expect 'and goes on from its last snapshot' 'going on from t = 4' \
  "$(grep -o 'going on from t = [0-9]*' "$log")"

rm "$work/out/paper/sp-constant-figure.masses.svg"
inventory > "$work/before"
run_make paper
expect 'a figure removed is drawn again, alone' paper/sp-constant-figure.masses.svg \
  "$(redone "$work/before")"

mkdir "$work/elsewhere"
cp "$work/paper/sp-logarithmic.toml" "$work/elsewhere/mine.toml"
inventory > "$work/before"
(cd "$work/elsewhere" && run_make study SCENE=mine.toml)
expect 'study works on a scene elsewhere' \
  "$({ made_from study/mine; echo study/mine.html; } | sort)" \
  "$(redone "$work/before" | insides_removed | sort)"

inventory > "$work/before"
run_make study SCENE="$work/elsewhere/mine.toml"
expect 'a second study of the same scene makes nothing' '' "$(redone "$work/before")"

mkdir "$work/another"
cp "$work/elsewhere/mine.toml" "$work/another/mine.toml"
touch --date=yesterday "$work/another/mine.toml"
run_make study SCENE="$work/another/mine.toml"
expect 'another scene of the same name is not taken for the first' \
  study/mine.results/run.json "$(redone "$work/before" | grep run.json)"

sed -i 's/^porosity .*/porosity = 1.3/' "$work/another/mine.toml"
inventory > "$work/before"
status=0
make -C "$workflows" "${make_arguments[@]}" OUT="$work/out" study SCENE="$work/another/mine.toml" \
  > "$log" 2>&1 || status=$?
expect 'a wrong scene stops make' 2 "$status"
expect 'and leaves what stood there' '' "$(redone "$work/before" | grep -v '\.inputs$\|\.log$\|\.status$')"

finish 'what make redoes'

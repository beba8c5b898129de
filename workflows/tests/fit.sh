#!/usr/bin/env bash
# Does a calibration through the programs find values that are known, make no run twice, go round runs that fail, and refuse
# wrong input? Works in a folder of its own, whose name has spaces; arguments go to make (BIN=FOLDER, -j2).
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
cd "$work/my scenes"
out="$work/o ut/fit/test"

fit() { run_script fit/fit.py SCENE="a column.toml" NAME=test "$@"; }

cp "$workflows/fit/column.geo" .
sed 's/^end .*/end = 2400.0/; s/^snapshot_every.*/snapshot_every = 2400.0/' "$workflows/fit/column.toml" > "a column.toml"
exact=(soil.sand.erosion.rate=1.2e-4 soil.silt.erosion.rate=1.1e-6)
"$programs/suffuse-mesher" "a column.toml" --set "${exact[0]}" --set "${exact[1]}" -o exact.case.h5 > /dev/null 2>&1
"$programs/suffuse-solver" exact.case.h5 --quiet -o exact.results
awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "fines_out") fines = i; print "t,ledger.fines_out,boundary.bottom.discharge" }
  FNR == NR { lost[$1] = $fines; next }
  FNR == 1 { for (i = 1; i <= NF; ++i) if ($i == "discharge") at = i }
  $2 == "bottom" && $1 > 0 && $1 % 300 == 0 { print $1 "," lost[$1] "," $at }' exact.results/{ledger,boundaries}.csv > points.csv
sed -n '1p; $p' points.csv > few.csv
points=(MEASURED=points.csv)
keys=(KEYS=soil.sand.erosion.rate,soil.silt.erosion.rate)

# --- Wrong input -------------------------------------------------------------------------------------------

# refused WHAT MESSAGE VARIABLE...: MESSAGE is the start of what is said.
refused() {
  fit "${@:3}"
  local found
  found=$(grep -m1 '^fit.py: ' "$log" | sed "s|$PWD/||g" || true)
  expect "$1" "2 fit.py: $2" "$code ${found:0:$((${#2} + 8))}"
}
refused 'bounds that leave out the start' \
  'KEYS: soil.sand.erosion.rate: got the bounds 1 and 2; expected bounds around 0.0001, the value of the scene' \
  "${points[@]}" KEYS=soil.sand.erosion.rate:1:2
refused 'a misspelt key, in the words of the mesher' '--set soil.sand.erosion.rat=0.5: soil.sand.erosion.rat: got an unknown key; expected law, ' \
  "${points[@]}" KEYS=soil.sand.erosion.rat
expect 'with the closest key' 'did you mean soil.sand.erosion.rate?' "$(said 'did you mean soil.sand.erosion.rate?')"
refused 'a key that is no number' 'a column.toml: soil.sand.erosion.law: got first-order; expected a number: only numbers can be fitted' \
  "${points[@]}" KEYS=soil.sand.erosion.law
refused 'a key without a start' \
  'a column.toml: soil.sand.erosion.residual: got no such key; expected a number, where the search starts, or bounds: KEYS=' \
  "${points[@]}" KEYS=soil.sand.erosion.residual
refused 'a start that the mesher refuses' '--set soil.sand.size_ratio=-2.0: soil.sand.size_ratio: got -2.0; expected a number' \
  "${points[@]}" KEYS=soil.sand.size_ratio:-5:1
printf 't,value\n600,1e-5\n99999,2\n' > late.csv
refused 'points after the end' 'late.csv:3: t: got 99999; expected times up to 2400 s, the end of the run' \
  MEASURED=late.csv AGAINST=history.flux_out "${keys[@]}"
refused 'fewer points than keys' 'few.csv: got 2 points; expected at least as many as there are keys, 3' MEASURED=few.csv \
  KEYS=soil.sand.erosion.rate,soil.silt.erosion.rate,soil.sand.erosion.threshold
fit MEASURED=none.csv
expect 'no such file' "2 MEASURED: got 'none.csv'; there is no such file" "$code $(said "MEASURED: got 'none.csv'; there is no such file")"
expect 'nothing was written' '' "$(ls "$work/o ut" 2> /dev/null || true)"
sed '1s/ledger.fines_out/ledger.fines_ot/' points.csv > misspelt.csv
refused 'a misspelt output' "misspelt.csv: got 'ledger.fines_ot'; expected one of history." MEASURED=misspelt.csv "${keys[@]}"
expect 'with the closest name' 'did you mean ledger.fines_out?' "$(said 'did you mean ledger.fines_out?')"
expect 'is refused after the first run' '0001 table.csv table.inputs' "$(echo $(ls "$out/runs" | grep '^0') $(ls "$out" | grep -v runs))"
fit "${points[@]}" "${keys[@]}" LAUNCH=false
expect 'a scheduler that refuses' '1 were stopped or not started' "$code $(said 'were stopped or not started')"

# --- A fit -------------------------------------------------------------------------------------------------

# close KEY VALUE: whether the key was found to 1e-4 of its value.
close() { awk -v found="$(cells "$out/fit.csv" "$1" value)" -v true="$2" 'BEGIN { d = found / true - 1; print (d * d < 1e-8 ? "close" : found) }'; }

run_make fit NAME=test SCENE="a column.toml" "${points[@]}" "${keys[@]}"
expect 'a fit of two soils, by make' 0 "$code"
expect 'a rate that is known, with the drive gradient, to 1e-4' close "$(close soil.sand.erosion.rate 1.2e-4)"
expect 'and one with the drive power' close "$(close soil.silt.erosion.rate 1.1e-6)"
expect 'units, and what is said' '1/s logarithm 0.0001 known m3/J logarithm 1e-06 known' \
  "$(echo $(for soil in sand silt; do cells "$out/fit.csv" soil.$soil.erosion.rate unit searched start said; done))"
expect 'files' "$(printf '%s\n' boundary.bottom.discharge.png boundary.bottom.discharge.svg correlations.csv fit.csv ledger.fines_out.png \
  ledger.fines_out.svg report.md residuals.csv runs search.csv table.csv table.inputs)" "$(ls "$out")"
expect 'curves of start and fit, and points' 'fit measured start' \
  "$(echo $(grep -o '>\(fit\|start\|measured\)<' "$out/ledger.fines_out.svg" | tr -d '<>' | sort))"
expect 'the run of the refused call is taken' 0001 "$(sed -n 2p "$out/search.csv" | cut -d, -f2)"
expect 'a residual for each point' "$((1 + 2 * ($(wc -l < points.csv) - 1)))" "$(wc -l < "$out/residuals.csv")"
expect 'the paragraph is printed' same "$([[ $(< "$log") == *"$(< "$out/report.md")"* ]] && echo same)"
expect_nothing_new search.csv fit "${points[@]}" "${keys[@]}"

# A stand-in of the solver fails where the rate is above a bound.
mkdir "$work/bin"
ln -s "$programs"/suffuse-{mesher,post} "$work/bin"
cat > "$work/bin/suffuse-solver" <<END
#!/usr/bin/env bash
if awk '/^set .*sand.erosion.rate=/ { sub(/.*=/, ""); if (\$0 > 1.205e-4) found = 1 } END { exit !found }' ./*.inputs; then
  echo 'the soil is gone' >&2
  exit 3
fi
exec "$programs/suffuse-solver" "\$@"
END
chmod +x "$work/bin/suffuse-solver"
sed -i 's/^rate  *= 1.0e-6/rate = 1.1e-6/' "a column.toml"
fit "${points[@]}" KEYS=soil.sand.erosion.rate PROGRAMS="$work/bin"
expect 'runs that fail do not end the search' '0 of the runs did not end well and count as bad trials: ' \
  "$code $(said 'of the runs did not end well and count as bad trials: ')"
expect 'the rate is found all the same' close "$(close soil.sand.erosion.rate 1.2e-4)"
expect 'and are named, with their message' 'failed (the soil is gone)' "$(said 'failed (the soil is gone)')"

"$workflows/tests/fit.py" || failures=$((failures + 1))
finish calibrations

#!/usr/bin/env bash
# Do studies of levels find levels and probabilities that are known exactly, go on after they were
# killed, and refuse what they cannot study? Does a sweep tell how safe its runs are? Works in a folder
# of its own, whose name has spaces; arguments go to make (BIN=FOLDER, -j2).
#
# Water rises through a column 1 m high with the head H below and 1 m above: i = H - 1. Erosion begins
# at i = 0.5, so at 1.5 m; heave at i' = (1 - 0.3) 1.7 = 1.19, so at 2.19 m. By EN 1997-1 forces balance
# at i = 0.9 / 1.35 i', so at 1.7933 m, and stresses at i = 0.9 / 1.35 (i' + 1) - 1, so at 1.46 m.
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
cd "$work/my scenes"

# level_of MECHANISM EXACT TOLERANCE: whether critical.csv has the exact level in a bracket that is
# narrow enough, and the level within a hundredth of the tolerance.
level_of() {
  awk -F, -v name="$1" -v exact="$2" -v tolerance="$3" '$1 == name {
      d = $2 - exact; narrow = $4 - $3 <= tolerance * 1.000001
      print ($3 <= exact && exact <= $4 && narrow && d * d <= tolerance * tolerance * 1e-4 ? "found" : $2 ": " $3 " to " $4)
    }' "$out/critical.csv"
}

cat > "a column.toml" <<'END'
formulation = "single-point"
gravity = [0.0, -9.81]
geometry = {shape = "column", width = 0.25, height = 1.0}
mesh.size = 0.25
liquid = {density = 1000.0, bulk_modulus = inf, viscosity = 1e-3}
boundary = [{on = "bottom", head = 1.5}, {on = "top", head = 1.0}, {on = "left", darcy_flux = 0.0}]
initial.flow = "steady"
time.end = 100.0
output.every = 50.0

[soil.specimen]
porosity = 0.3
skeleton_fraction = 0.6
grain_density = 2700.0
conductivity = 1e-4
erosion = {law = "first-order", drive = "gradient", rate = 1e-6, threshold = 0.5}
END
column=(SCENE="a column.toml" BOUNDARY=bottom)

out="$work/o ut/critical-level/a column"
search=(critical-level "${column[@]}" FROM=1.1 TO=3.1 SCAN=2 TOLERANCE_LEVEL=0.01)
run_make "${search[@]}"
expect 'a critical level' 0 "$code"
expect 'erosion begins where its threshold is' found "$(level_of erosion 1.5 0.01)"
expect 'heave begins at the critical gradient' found "$(level_of heave 2.19 0.01)"
expect 'and by EN 1997-1 with its factors' 'found found' "$(level_of hyd-stresses 1.46 0.01) $(level_of hyd-forces 1.793333333 0.01)"
expect 'the lowest one governs' 'Heave by EN 1997-1, stresses begins at 1.46 m' "$(said 'Heave by EN 1997-1, stresses begins at 1.46 m')"
expect 'soil without a strength has no slope' 'slope was not looked at: no soil has a strength.' "$(said 'slope was not.*')"
expect 'files' "$(printf '%s\n' critical.csv levels.csv levels.svg report.md runs table.csv)" "$(ls "$out")"
expect 'the least factor governs at each level' "$(printf '%s\n' hyd-stresses erosion)" "$(awk -F, 'NR > 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^(erosion|hyd-.*|heave)$/) print $i }' "$out/levels.csv" | uniq)"
expect_nothing_new levels.csv run_make "${search[@]}"

run_make critical-level "${column[@]}" FROM=1.6 TO=2 SCAN=2 NAME=ends
expect 'a level below FROM' 'Erosion begins below FROM = 1.6 m: its factor is 0.833 there. It governs.' "$(said 'Erosion.*')"
expect 'a level above TO' 'heave begins above TO = 2 m: its factor is 1.19 there.' "$(said 'heave begins.*')"

# tolerance_in TARGET VARIABLE...: what the runs of a target get. They are not made.
tolerance_in() {
  run_make "$@" "${column[@]}" LAUNCH=echo NAME=told
  grep -o ' 0001/0001 [0-9e-]*' "$log" | head -1 | cut -d' ' -f3
}
printf '%s\n' 'boundary[0].head' 2.0 > heads.csv
printf '%s\n' 'soil.specimen.porosity' 0.3 > porosities.csv
expect 'masses of a sweep are those that rounding leaves' '1e-12 1e-6' "$(tolerance_in sweep SWEEP=heads.csv) $(tolerance_in sweep SWEEP=heads.csv TOLERANCE=1e-6)"
expect 'an answer needs nine digits of them' '1e-9 1e-9' \
  "$(tolerance_in critical-level FROM=1 TO=2) $(tolerance_in fragility LEVELS=1 SWEEP=porosities.csv)"
expect 'or as many as are asked for' '1e-12 1e-11' "$(tolerance_in critical-level FROM=1 TO=2 TOLERANCE=1e-12) $(TOLERANCE=1e-11 tolerance_in critical-level FROM=1 TO=2)"

# A boundary of the same water that would stay where it is.
sed 's/on = "left", darcy_flux = 0.0/on = "left", head = 1.5/' "a column.toml" > waters.toml
run_make critical-level SCENE=waters.toml BOUNDARY=bottom FROM=1.5 TO=2 SCAN=2 TOLERANCE_LEVEL=0.5 FACTOR=checks
low='"left" has the head of "bottom" in the scene, 1.5 m, and keeps it at all levels; if it borders the same water, the result is not safe: give BOUNDARY="bottom left"'
expect 'a boundary that stays low is warned of' "$(printf '%s\n' "Warning: $low." "critical_level.py: warning: BOUNDARY: $low")" \
  "$(head -1 "$work/o ut/critical-level/waters/report.md"; grep '^critical_level.*BOUNDARY' "$log")"
run_make critical-level SCENE=waters.toml BOUNDARY="bottom left" FROM=1.5 TO=2 SCAN=2 TOLERANCE_LEVEL=0.5 FACTOR=checks
expect 'both get the level' '0 boundary[0].head,boundary[2].head 2.0,2.0 ' \
  "$code $(sed -n '1p; 3p' "$work/o ut/critical-level/waters/table.csv" | cut -d, -f1,2 | xargs) $(grep -o Warning "$work/o ut/critical-level/waters/report.md" || true)"

# Water that sinks lifts nothing, and nothing erodes.
sed '/^erosion/d' "a column.toml" > sinking.toml
out="$work/o ut/critical-level/sinking"
no_mechanism="no mechanism acts in this run: no check has a factor, and suffuse-post check $out/runs/0001/0001.results says why"
run_make critical-level SCENE=sinking.toml BOUNDARY=bottom FROM=0.5 TO=0.75 SCAN=2
expect 'runs in which nothing acts' "2 critical_level.py: 0001 done: $no_mechanism; no soil has a strength" "$code $(grep '0001 done: no' "$log")"
run_make critical-level SCENE=sinking.toml BOUNDARY=bottom FROM=0.5 TO=0.75 SCAN=2 FACTOR=checks
expect 'or in which the slope is left out' "2 critical_level.py: 0001 done: $no_mechanism; the slope was not looked at" "$code $(grep '0001 done: no' "$log")"
out="$work/o ut/critical-level/a column"

# What the mesher warns of is in the logs of the runs.
run_make critical-level "${column[@]}" FROM=1.6 TO=400 SCAN=2 NAME=high FACTOR=checks
expect 'warnings of the runs are shown' 'critical_level.py: warning: boundary[0].head: 400 m, and the model lies between 0 and 1 m' \
  "$(grep -o 'critical_level.py: warning: boundary.* 1 m' "$log")"
expect 'at the end' 'critical_level.py: warning' "$(grep -v '^make' "$log" | tail -1 | grep -o '^critical_level.py: warning')"

# Gravel over silt: no filter, whatever the level.
cat > layers.geo <<'END'
Point(1) = {0, 0, 0};  Point(2) = {0.25, 0, 0};  Point(3) = {0.25, 0.5, 0};
Point(4) = {0.25, 1, 0};  Point(5) = {0, 1, 0};  Point(6) = {0, 0.5, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 5};  Line(5) = {5, 6};  Line(6) = {6, 1};  Line(7) = {6, 3};
Curve Loop(1) = {1, 2, -7, 6};  Plane Surface(1) = {1};  Physical Surface("silt") = {1};
Curve Loop(2) = {7, 3, 4, 5};  Plane Surface(2) = {2};  Physical Surface("gravel") = {2};
Physical Curve("bottom") = {1};  Physical Curve("top") = {4};
END
sed 's/^geometry.*/geometry.file = "layers.geo"/; s/, {on = "left", darcy_flux = 0.0}//; s/soil.specimen/soil.silt/' "a column.toml" > layers.toml
cat >> layers.toml <<'END'
gradation = [[0.002, 0], [0.01, 15], [0.05, 85], [0.1, 100]]
[soil.gravel]
like = "silt"
gradation = [[2.0, 0], [4.0, 15], [20.0, 85], [40.0, 100]]
END
out="$work/o ut/critical-level/layers"
run_make critical-level SCENE=layers.toml BOUNDARY=bottom FROM=1.1 TO=1.9 SCAN=2 TOLERANCE_LEVEL=0.1
expect 'filters do not depend on the level' "0 $(printf '%s\n' erosion heave hyd-stresses hyd-forces)" "$code $(sed 1d "$out/critical.csv" | cut -d, -f1)"
expect 'and are said once' 'Not part of the search, as they do not depend on the level: filter retention silt -> gravel has a factor of 0.05 and is exceeded; filter drainage and internal stability hold.' \
  "$(grep 'filter\|loss' "$out/report.md" | sed 's/filter silt -> gravel has a factor of [0-9.]* and is exceeded; //')"
expect 'they have no column' '' "$(head -1 "$out/levels.csv" | grep -o 'filter' || true)"

# Sand without cohesion is lifted where heave begins: there it has no equilibrium, and no factor.
sed 's/"bottom"/"bottom", fix = "both"/; s/"left", darcy_flux = 0.0/"left", fix = "normal"}, {on = "right", fix = "normal"/; /^erosion/d' "a column.toml" > lifted.toml
cat >> lifted.toml <<'END'
skeleton = {law = "mohr-coulomb", young = 1e7, poisson = 0.3, friction = 30, cohesion = 0.0}
END
out="$work/o ut/critical-level/lifted"
lifted=(critical-level SCENE=lifted.toml BOUNDARY=bottom FROM=1.8 TO=2.6 SCAN=2 TOLERANCE_LEVEL=0.1)
run_make "${lifted[@]}"
expect 'soil that fails is an answer' '0 between' "$code $(awk -F, '$1 == "slope" && $3 <= 2.19 && 2.19 <= $4 && $4 - $3 <= 0.1000001 { print "between" }' "$out/critical.csv")"
expect 'what is not checked where soil moves is said' 'Heave by EN 1997-1 and uplift are not checked where soil moves' "$(said 'Heave by EN.*soil moves')"
expect 'with its message' 'it fails without a factor: ' "$(said 'it fails without a factor: ')"
# The slope is looked at apart: the flow comes from runs with elastic soil, also where soil fails.
expect 'no run fails' '' "$(sed 1d "$out/levels.csv" | cut -d, -f3 | grep -v done || true)"
expect 'so heave is found, too' found "$(level_of heave 2.19 0.1)"
expect 'the slope has fewer levels than all together' fewer \
  "$(awk 'FNR == NR { ++all; next } { ++slope } END { print slope < all ? "fewer" : slope " of " all }' "$out/table.csv" "$out/slope.csv")"
expect 'and a factor for each' "$(sed 1d "$out/slope.csv" | wc -l)" "$(find "$out/slope" -name '*.assessed' | wc -l)"
before=$(statuses "$out")
expect_nothing_new levels.csv run_make "${lifted[@]}"
rm "$out/slope/0004/0004.assessed"
run_make "${lifted[@]}"
expect 'one that is missing is made again' "$(cut -d' ' -f1 <<< "$before") 1" \
  "$(statuses "$out" | cut -d' ' -f1) $(comm -13 <(echo "$before") <(statuses "$out") | grep -c assessed)"

# Level ground has no finite factor below the water that lifts it; it is found again when the options change, and when
# they go.
printf '%s\n' 'boundary[0].head' 1.8 > head.csv
out="$work/o ut/sweep/head"
factors=()
for options in '' 'REGION=specimen' 'REGION=specimen DEEPER=0.3' 'QUADRATIC=1' ''; do
  before=$(statuses "$out" 2> /dev/null || true)
  IFS=' ' read -ra given <<< "$options"
  run_make sweep SCENE=lifted.toml SWEEP=head.csv FACTOR=start "${given[@]}"
  factors+=("$(tail -1 "$out/0001/0001.factors.csv" | cut -d, -f2)")
  expect "factors of '$options' are made again, and no run" "assessed$([ -n "$before" ] || echo ' status')" \
    "$(comm -13 <(echo "$before") <(statuses "$out") | sed 's/ .*//; s/.*[.]//' | xargs)"
done
expect 'level ground stands with any strength, whatever is left out' 'same inf inf inf same' \
  "$(awk -v a="${factors[0]}" -v b="${factors[1]}" -v c="${factors[2]}" -v d="${factors[3]}" -v e="${factors[4]}" \
    'BEGIN { print (a == b ? "same" : a " " b), (c > 1.05 * b ? "more" : c " " b), (d > 0 && d != a ? "other" : d), (e == a ? "same" : e) }')"
run_make sweep SCENE=lifted.toml SWEEP=head.csv FACTOR=start REGION=soil NAME=refused
expect 'no such soil' "2 REGION: got 'soil'; expected soils with a strength, with spaces between several: specimen none" \
  "$code $(grep ^REGION "$log") $(ls "$work/o ut/sweep/refused" 2> /dev/null || echo none)"
run_make sweep SCENE=lifted.toml SWEEP=head.csv DEEPER=1 NAME=refused
expect 'a depth without a factor' "2 DEEPER: got '1' without FACTOR; expected FACTOR=1, all or start beside it" "$code $(grep ^DEEPER "$log")"
run_make critical-level SCENE=lifted.toml BOUNDARY=bottom FROM=1.1 TO=1.8 SCAN=2 TOLERANCE_LEVEL=0.7 NAME=skin REGION=specimen DEEPER=0.3
expect 'the report says what is left out' \
  'Of the slope, only specimen can fail, other soil is elastic, and bodies within 0.3 m of the surface are left out.' "$(said 'Of the slope.*')"
expect 'and the slope is that factor' "${factors[2]}" "$(tail -1 "$work/o ut/critical-level/skin/slope/0002/0002.factors.csv" | cut -d, -f2)"

# A flood of 20 s: erosion begins at its highest head, as nothing is stored. The level is the same as under a steady head.
sed 's/head = 1.5/head = [[0, 1.0], [10, 2.0], [20, 1.0]]/; s/^initial.*/initial.water_level = 1.0/; s/^time.*/time.end = 20.0/
  s/^output.*/output.every = 5.0/' "a column.toml" > flood.toml
out="$work/o ut/critical-level/flood"
run_make critical-level SCENE=flood.toml BOUNDARY=bottom FROM=1.4 TO=1.6 SCAN=2 TOLERANCE_LEVEL=0.02 FACTOR=checks
expect 'a hydrograph' '0 found' "$code $(level_of erosion 1.5 0.02)"
cp "$out/table.csv" "$work/table"
run_make critical-level "${column[@]}" FROM=1.4 TO=1.6 NAME=flood
expect 'the study of another scene is not replaced' '2 same 1' \
  "$code $(cmp "$work/table" "$out/table.csv" && echo same) $(grep -c 'runs: got the runs of .*flood.toml and .*table.csv; expected another NAME=' "$log")"

# The same draws at both levels. In a draw erosion begins at H - 1 = threshold.
printf '%s\n' runs,6 seed,2 sampling,latin-hypercube key,distribution,mean,deviation,min,max \
  soil.specimen.erosion.threshold,lognormal,0.6,0.2,, > draws.csv
fragility=(fragility "${column[@]}" LEVELS=1.45,1.65 SWEEP=draws.csv)
out="$work/o ut/fragility/a column"
run_make "${fragility[@]}"
expect 'a fragility' 0 "$code"
# P = Phi((ln i - m) / s), s2 = ln(1 + (0.2 / 0.6)^2), m = ln 0.6 - s2 / 2.
expect 'the probability is within its bounds, failures are the draws below i' 'yes yes' \
  "$(/usr/bin/python3 - "$out" <<'END'
import csv, math, statistics, sys
variance = math.log1p((0.2 / 0.6) ** 2)
law = statistics.NormalDist(math.log(0.6) - variance / 2, math.sqrt(variance))
thresholds = {row["run"]: float(row["soil.specimen.erosion.threshold"]) for row in csv.DictReader(open(f"{sys.argv[1]}/runs/runs.csv"))}
draws = sorted(thresholds.values())[::2]
for row in csv.DictReader(open(f"{sys.argv[1]}/fragility.csv")):
    if row["mechanism"] == "erosion":
        gradient = float(row["level [m]"]) - 1.0
        exact = float(row["low [-]"]) <= law.cdf(math.log(gradient)) <= float(row["high [-]"])
        counted = int(row["failures"]) == sum(draw < gradient for draw in draws)
        print("yes" if exact and counted else f"{row} {draws}", end=" " if gradient < 0.5 else "")
END
)"
expect 'each mechanism, and any of them' "$(printf '%s\n' 'any but erosion' 'any of them' erosion heave hyd-forces hyd-stresses mechanism)" "$(cut -d, -f1 "$out/fragility.csv" | sort -u)"
expect 'files' "$(printf '%s\n' draws.csv fragility.csv fragility.svg report.md runs table.csv)" "$(ls "$out")"
for table in fragility.csv draws.csv runs/sweep.csv; do cp "$out/$table" "$work/${table##*/}"; done
rm -rf "$out"
# One run at a time, killed in the middle.
(make -C "$workflows" "${make_arguments[@]}" -j1 OUT="$work/o ut" "${fragility[@]}" > /dev/null 2>&1) & caller=$!
for ((i = 0; i < 600; ++i)); do [ ! -e "$out/runs/0003/0003.status" ] || break; sleep 0.1; done
for pid in $(tree "$caller"); do kill -9 "$pid" 2> /dev/null || true; done
{ wait "$caller" || true; } 2> /dev/null
expect 'killed before its end' '' "$(ls "$out" | grep fragility || true)"
run_make "${fragility[@]}" -j1
for table in fragility.csv draws.csv runs/sweep.csv; do
  expect "one by one, killed and called again: the same ${table##*/}" same "$(cmp "$work/${table##*/}" "$out/$table" && echo same)"
done

printf '%s\n' 'boundary[0].head' 2.0 2.5 > heads.csv
run_make sweep SCENE="a column.toml" SWEEP=heads.csv FACTOR=1
out="$work/o ut/sweep/heads"
expect 'a sweep that tells how safe its runs are: erosion at i over 0.5' '0 factor_erosion 0.5 0.3333333333' "$code $(echo $(column factor_erosion))"
expect 'heave' 'yes' "$(echo $(column factor_heave) | awk '{ print ($2 / 1.19 - 1) ^ 2 < 1e-9 && ($3 / 1.19 * 1.5 - 1) ^ 2 < 1e-9 ? "yes" : $0 }')"
expect 'a state without a factor has the reason' 'factor factor_message no soil has a strength no soil has a strength' \
  "$(echo $(column factor) $(column factor_message))"
expect 'no column of times' '' "$(head -1 "$out/sweep.csv" | grep -o 'seconds' || true)"
expect_nothing_new sweep.csv run_make sweep SCENE="a column.toml" SWEEP=heads.csv FACTOR=1
run_make sweep SCENE="a column.toml" SWEEP=heads.csv FACTOR=2
expect 'an unknown FACTOR' "2 FACTOR: got '2'; expected 1, all, start or checks" "$code $(grep ^FACTOR "$log")"
run_make sweep SCENE="a column.toml" SWEEP=heads.csv
expect 'without FACTOR no such columns' '0 ' "$code $(head -1 "$out/sweep.csv" | grep -o 'factor' || true)"

# refused WHAT MESSAGE SCRIPT VARIABLE...
refused() {
  run_script "level/$3.py" NAME=refused "${@:4}"
  expect "$1" "2 $3.py: $2" "$code $(grep -m1 "^$3.py: " "$log")"
}
refused 'FROM above TO' 'FROM: got 3, and TO=1; expected a level below TO' critical_level "${column[@]}" FROM=3 TO=1
refused 'no TO' 'TO: got nothing; expected a number' critical_level "${column[@]}" FROM=3
refused 'a boundary without a head' \
  'BOUNDARY: got "left", which has no head; expected a boundary with a head: "bottom" or "top"' \
  critical_level "${column[@]}" BOUNDARY=left FROM=1 TO=3
refused 'levels that fall' "LEVELS: got '3,1'; expected rising numbers with commas between them, m" \
  fragility "${column[@]}" LEVELS=3,1 SWEEP=draws.csv
refused 'draws of the head' "$PWD/heads.csv: boundary[0].head: got a key that this study sets; expected other keys: \
the level is that of LEVELS, others are in SET" fragility "${column[@]}" LEVELS=1,3 SWEEP=heads.csv
refused 'a depth that is none' "DEEPER: got '0'; expected a depth above 0, m" \
  critical_level SCENE=lifted.toml BOUNDARY=bottom FROM=1 TO=3 DEEPER=0
refused 'soil that does not fail' \
  "REGION: got 'specimen'; expected soils with a strength, with spaces between several: a scene with such a soil; this one has none" \
  fragility "${column[@]}" LEVELS=1,3 SWEEP=draws.csv REGION=specimen
expect 'nothing is written' none "$(ls "$work/o ut/critical-level/refused" "$work/o ut/fragility/refused" 2> /dev/null || echo none)"
refused 'keys that the mesher refuses' "no run can be made: --set soil.specimen.porosity=2: soil.specimen.porosity: \
got 2; expected a number with 0 < n_0 < 1" \
  critical_level "${column[@]}" FROM=1.1 TO=3 SCAN=2 SET=soil.specimen.porosity=2

"$workflows/tests/level.py" || failures=$((failures + 1))
finish levels

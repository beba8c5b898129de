#!/usr/bin/env bash
# Does a study of convergence make its runs by the sweep's engine, say what it finds, and refuse what
# it cannot study? Works in a folder of its own, whose name has spaces; arguments go to make
# (BIN=FOLDER, -j2).
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
cd "$work/my scenes"

# study NAME VARIABLE...: also sets `out` to the folder.
study() {
  out="$work/o ut/convergence/$1"
  run_make convergence NAME="$1" "${@:2}"
}

cp "$workflows/examples/weir/weir.geo" .
sed 's/^end .*/end = 20.0/' "$workflows/examples/weir/weir.toml" > "a weir.toml"
cat >> "a weir.toml" <<'END'
probe = [{at = [1.5, 0.5]}]
END
weir=(SCENE="a weir.toml" SIZES=0.2,0.1,0.05 OUTPUTS="flux_out,settlement_max,probe[0].pressure")

study weir "${weir[@]}" OUTPUTS=flux_ot,nothing
expect 'unknown outputs' "2 OUTPUTS: got 'flux_ot'; expected one of fines_lost, " \
  "$code $(said "OUTPUTS: got 'flux_ot'; expected one of fines_lost, ")"
expect 'with the closest name' 'did you mean flux_out?' "$(said 'did you mean flux_out?')"
expect 'are refused after the coarsest run' 0001 "$(ls "$out/runs" | grep '^0')"

study weir "${weir[@]}"
expect 'a study' 0 "$code"
expect 'its runs are a sweep, sizes first, then tolerances' \
  "$(printf '%s\n' run,mesh.size,time.tolerance,time.inertia 0001,0.2,0.001, 0002,0.1,0.001, 0003,0.05,0.001, 0004,0.1,0.004,false \
    0005,0.1,0.00025,false)" \
  "$(cat "$out/runs/runs.csv")"
expect 'files' "$(printf '%s\n' convergence.csv flux_out.png flux_out.svg plan.json probe-0-.pressure.png probe-0-.pressure.svg \
  report.md runs settlement_max.png settlement_max.svg table.csv)" "$(ls "$out")"
expect 'rows' "$(printf '%s\n' output flux_out settlement_max 'probe[0].pressure')" "$(cut -d, -f1 "$out/convergence.csv")"
expect 'units, and what is in its range' 'm3/s/m yes' "$(cells "$out/convergence.csv" flux_out unit in_range)"
expect 'values are those of the sweep' same "$(awk -F, 'NR == FNR { if (FNR == 1) { for (i = 1; i <= NF; ++i) if ($i == "flux_out") at = i }
    else if ($1 == "0003") wanted = $at; next }
  FNR == 1 { for (i = 1; i <= NF; ++i) if ($i == "mesh.size 0.05") at = i }
  $1 == "flux_out" { d = $at / wanted - 1; print (d * d < 1e-18 ? "same" : $at " " wanted) }' \
  <(sed 's/"[^"]*"//g' "$out/runs/sweep.csv") "$out/convergence.csv")"
expect 'an output that is always 0' 'yes constant 0' "$(cells "$out/convergence.csv" settlement_max in_range said_of_sizes gci_space_percent)"
expect 'the paragraph is printed' 'The discharge that leaves (flux_out) is' "$(said 'The discharge that leaves (flux_out) is')"
expect 'and written' same "$([[ $(< "$log") == *"$(< "$out/report.md")"* ]] && echo same)"

expect_nothing_new convergence.csv study weir "${weir[@]}"

# A channel grows in a path as wide as an element, and finer elements lose more and more fines.
cp "$workflows/laboratory/channel.geo" .
sed 's/^end .*/end = 600.0/; s/^snapshot_every.*/snapshot_every = 600.0/' "$workflows/laboratory/channel.toml" > channel.toml
study channel SCENE=channel.toml SIZES=0.04,0.02,0.01 OUTPUTS=fines_lost
expect 'a channel as wide as an element is not in its range: no value and no index' '0 no diverging   ' \
  "$code $(cells "$out/convergence.csv" fines_lost in_range said_of_sizes order extrapolated gci_space_percent)"
expect 'and the paragraph says so' 'The differences between them do not fall as the sizes do. This series is not in its range of convergence, so there is no' \
  "$(said 'The differences between them do not fall as the sizes do. This series is not in its range of convergence, so there is no')"

# refused WHAT MESSAGE SCENE VARIABLE...
refused() {
  run_script convergence/convergence.py SCENE="$3" OUT_FOLDER="$work/refused" MAKE=false "${@:4}"
  expect "$1" "2 convergence.py: $2" "$code $(head -1 "$log")"
}
refused 'sizes that are no numbers' "SIZES: got 'x'; expected numbers above 0 with commas between them" "a weir.toml" SIZES=0.2,x
refused 'two sizes' "SIZES: got '0.2,0.1'; expected at least three different numbers" "a weir.toml" SIZES=0.2,0.1
refused 'tolerances out of bounds' "TOLERANCES: got '0.2'; expected numbers above 0 up to 0.1 with commas between them" \
  "a weir.toml" TOLERANCES=0.2,0.1,0.01
refused 'an output twice' "OUTPUTS: got 'flux_out' twice; expected different names with commas between them" \
  "a weir.toml" OUTPUTS=flux_out,flux_out
sed 's/^end .*/end = 30.0\nstep = 1.0/' "$workflows/examples/weir/weir.toml" > step.toml
refused 'tolerances of a given step' \
  'TOLERANCES: got numbers, and a scene with time.step; expected a scene whose steps follow time.tolerance' \
  step.toml TOLERANCES=1e-2,1e-3,1e-4
sed 's/^size .*/size = 0.1\nerror = 0.01/' "$workflows/examples/weir/weir.toml" > adapted.toml
refused 'a scene whose sizes follow an error' "$PWD/adapted.toml: mesh.error: got 0.01; expected a scene without this key: with it the \
sizes of elements do not follow mesh.size" adapted.toml
sed 's/weir.geo/weir.msh/' "$workflows/examples/weir/weir.toml" > made.toml
refused 'a mesh that is made already' "$PWD/made.toml: geometry.file: got 'weir.msh', a mesh whose elements have their sizes; expected a \
shape, or a .geo or .step file, whose elements follow mesh.size" made.toml
sed -i 's/weir.geo/graded.geo/' "a weir.toml"
sed 's/\(Point([0-9]*) = {[^}]*\)}/\1, 0.1}/g' "$workflows/examples/weir/weir.geo" > graded.geo
refused 'a file with sizes of its own' "$PWD/a weir.toml: mesh.size: got 2208 elements with 0.4 m and 2208 with 0.2 m; expected elements \
that become finer by 2, as mesh.size does" "a weir.toml" SIZES=0.4,0.2,0.1
expect 'with what to do' 'Leave the fourth number of its points out' "$(said 'Leave the fourth number of its points out')"

study launched SCENE=step.toml SIZES=0.2,0.1,0.05 LAUNCH=false
expect 'a scheduler that refuses' '2 0 of 1 runs are done' "$code $(said '0 of 1 runs are done')"

"$workflows/tests/convergence.py" || failures=$((failures + 1))
finish 'studies of convergence'

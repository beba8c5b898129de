#!/usr/bin/env bash
# Do meshes that follow a run know its discharge, where those of its start do not? Are scenes without
# mesh.size meshed again, and those that nothing drives left alone? Arguments go to make (BIN=FOLDER).
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
cd "$work/my scenes"

# rows RESULTS: time, discharge, low and high of each row.
rows() { cut -d, -f1,5,33,34 "$1/history.csv" | tail -n +2; }
# worst RESULTS: how far its discharge is off those of the fine mesh, in per cent of the largest.
worst() {
  paste -d, <(rows "$1") <(rows fine.results) | awk -F, '
    { exact = ($7 + $8) / 2; off = $2 > exact ? $2 - exact : exact - $2
      if (off > most) most = off
      if (exact > largest) largest = exact }
    END { print 100 * most / largest }'
}
holds() { awk "BEGIN { print ($1) ? \"yes\" : \"no: $1\" }"; }

# --- A river that rises later ---------------------------------------------------------------------
cp "$workflows"/adapt/second-weir.* .
mesher=$programs/suffuse-mesher solver=$programs/suffuse-solver
"$mesher" second-weir.toml --set mesh.size=0.1 -o fine.case.h5 > "$work/mesher.log"
"$solver" fine.case.h5 --quiet -o fine.results

run_make adapt SCENE=second-weir.toml
expect 'a mesh for the start is made' 0 "$code"
"$solver" "$work/o ut/adapt/second-weir.case.h5" --quiet -o start.results
expect 'it is met at the start, and not later' 'yes no' "$(rows start.results | awk -F, '
    { off = ($4 - $3) / 2; if (NR == 1) first = off / ($3 + $4) * 2; if (off > most) most = off
      if ($4 + $3 > 2 * largest) largest = ($3 + $4) / 2 }
    END { print (first <= 0.01 ? "yes" : "no"), (most <= 0.01 * largest ? "yes" : "no") }')"
off=$(worst start.results)
expect 'the discharge of the flood is off by more than 2 %' yes "$(holds "$off > 2")"

run_make adapt SCENE=second-weir.toml OVER=run
expect 'a mesh for the whole run is made' 0 "$code"
expect 'it says when least is known' yes \
  "$(grep -q '^mesh 1: Q = .* m3/s per m at t = 2000 s, when least is known of it, between' "$log" && echo yes)"
expect 'and is met' 1 "$(grep -c '^mesh.error = 0.01 is met$' "$log")"
run="$work/o ut/adapt/second-weir.results"
off=$(worst "$run")
expect 'the discharge is off by less than 1 % at any time' yes "$(holds "$off < 1")"
expect 'and the exact one between the bounds' '' "$(paste -d, <(rows "$run") <(rows fine.results) |
  awk -F, '{ exact = ($7 + $8) / 2; if (exact < $3 || exact > $4) print }')"
elements=$(sed -n 's/^  elements  *//p' "$log")
expect 'with less than a tenth of the elements' yes \
  "$(holds "$elements < 0.1 * $(sed -n 's/^  elements  *//p' "$work/mesher.log")")"
expect 'the table has a row for each mesh' "$(grep -c '^mesh [0-9]*:' "$log")" \
  "$(tail -n +2 "$work/o ut/adapt/second-weir.adapt.csv" | grep -c '^[0-9]*,[0-9.e-]*,[0-9.e-]*,[0-9.e-]*$')"
expect 'nothing else is left' "$(printf '%s\n' second-weir.{adapt.csv,case.h5,results})" "$(ls "$work/o ut/adapt")"

run_make adapt SCENE=second-weir.toml OVER=night
expect 'what is over something else is refused' "2 OVER: got 'night'; expected run" \
  "$code $(grep -o "OVER: got.*run" "$log")"

# --- An estimate that does not fall, from programs that only say so -----------------------------
mkdir stub
printf '#!/bin/sh\necho stub.case.h5\n' > stub/suffuse-mesher
cat > stub/suffuse-solver <<'END'
#!/bin/sh
echo x >> meshes
count=$(wc -l < meshes)
echo "Q = 2.0 m3/s per m, estimated between 1.0 and 3.0 (+- 50 %), $((100 * count * count)) elements"
echo 'mesh.error = 0.01 is not met: mesh again with suffuse-mesher --sizes stub.sizes.h5'
END
chmod +x stub/*
code=0
"$workflows/adapt.py" stub stub.toml stub > stub.log 2>&1 || code=$?
expect 'the loop ends where more elements hardly help' \
  '3 2 mesh.error is not met, and more elements hardly help: the case has the last mesh' \
  "$code $(wc -l < meshes) $(tail -1 stub.log)"

# --- Scenes without mesh.size ---------------------------------------------------------------------
sed '/^\[mesh\]/,/^$/d' second-weir.toml > plain.toml
again='; make study and make sweep mesh again until the discharge is known to 1 %'
"$mesher" plain.toml -o plain.case.h5 > "$work/summary"
expect 'the mesher says that studies mesh again' yes \
  "$(grep -q "note: mesh.size was not given: .* m, for about 20 000 elements$again\$" "$work/summary" && echo yes)"
run_make study SCENE=plain.toml
expect 'a study does' '0 done' "$code $(head -1 "$work/o ut/study/plain.status")"
expect 'on more than one mesh, to 1 %' '1 1' \
  "$(grep -c '^mesh 2: Q' "$log") $(grep -c '^mesh.error = 0.01 is met$' "$log")"
expect 'its run says between which values the discharge lies' yes \
  "$(rows "$work/o ut/study/plain.results" | awk -F, 'NR == 1 { print ($3 > 0 && $4 - $3 < 0.02 * $3 ? "yes" : "no") }')"

sed 's/^head .*/head = 6.0/' plain.toml > still.toml
sed 's/^bulk_modulus .*/bulk_modulus = 2e6/; s/^end .*/end = 0.05\nscheme = "explicit"/; s/^every .*/every = 0.05/' \
  plain.toml > explicit.toml
run_make study SCENE=still.toml
expect 'still water is run on the mesh that there is' '0 done' "$code $(head -1 "$work/o ut/study/still.status")"
expect 'which it says' 1 "$(grep -c '^not meshed again: .*: got no flow that heads drive, at t = 0' "$log")"
run_make study SCENE=explicit.toml
expect 'and so is the explicit scheme' '0 done 0' \
  "$code $(head -1 "$work/o ut/study/explicit.status") $(grep -c 'meshed again\|mesh again' "$log")"

printf '%s\n' mesh.max_elements 200000 15000 > most.csv
run_make sweep SCENE=plain.toml SWEEP=most.csv
expect 'runs of a sweep are meshed again' '0 1 1' "$code $(cd "$work/o ut/sweep/most" &&
  echo "$(grep -c 'error = 0.01 is met$' 0001/0001.log) $(grep -c '^not meshed again: .*raise one of the two' 0002/0002.log)")"
printf '%s\n' mesh.size 1.0 > size.csv
run_make sweep SCENE=plain.toml SWEEP=size.csv
expect 'but not those with a size' '0 0' "$code $(grep -c '^mesh 1' "$work/o ut/sweep/size/0001/0001.log")"

finish 'adapted meshes'

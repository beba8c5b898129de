#!/usr/bin/env bash
# Does the fit to a seepage test find the exact values, and does it refuse wrong tables? Works in a
# folder of its own; arguments go to make (BIN=FOLDER).
set -euo pipefail

. "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
work=$scratch
cd "$workflows"

# fit MEASURED GRADIENTS OPTION...: exit code and the last line of what it says.
fit() {
  local status=0 measured=$1 gradients=$2
  shift 2
  /usr/bin/python3 laboratory/fit.py examples/permeameter/specimen.toml --measured "$measured" --gradients "$gradients" \
    --fit constant --programs "$programs" --out "$work/out" "$@" > "$log" 2>&1 || status=$?
  echo "$status $(sed "s|$work/||g" "$log" | tail -1)"
}

# The measured values are exact for a rate of 1.5e-5 1/s and a residual of half of the fines,
# 0.04875, except for the minutes in which water passes the specimen. One test has stages of 10 h
# with gradients 1 and 2.
awk 'BEGIN {
  rate = 1.5e-5
  print "run,hours,fines_lost,conductance"
  for (hours = 4; hours <= 12; hours += 4) printf "constant,%d,%.12g,1\n", hours, 50 * (1 - exp(-rate * 5 * 3600 * hours))
  printf "steps,20,%.12g,1\n", 50 * (1 - exp(-rate * 3 * 36000))
}' > "$work/exact.csv"
printf '%s\n' run,until_hours,gradient constant,12,5 steps,10,1 steps,20,2 > "$work/gradients.csv"
fit "$work/exact.csv" "$work/gradients.csv" > /dev/null
expect 'rate and residual that are known are found, to half a per cent' 'close' \
  "$(awk '$1 == "rate" { r = $2 / 1.5e-5 - 1 } $1 == "residual" { s = $2 / 0.04875 - 1 }
       END { print (r * r < 2.5e-5 && s * s < 2.5e-5 && r * r > 0 ? "close" : r " " s) }' "$log")"
expect 'what they predict of another test is exact to 0.1 per cent points' 'close' \
  "$(awk -F, '$1 == "steps" { d = $5 - $4; print (d * d < 0.01 ? "close" : d) }' "$work/out/fit.csv")"
cp "$work/out/search.csv" "$work/search.csv"
fit "$work/exact.csv" "$work/gradients.csv" > /dev/null
expect 'the same search again' 'same' "$(cmp -s "$work/search.csv" "$work/out/search.csv" && echo same)"

# refused WHAT MESSAGE LINE...: fits to a table of these lines.
refused() {
  local what=$1 message=$2
  shift 2
  printf '%s\n' "$@" > "$work/wrong.csv"
  expect "$what" "2 fit.py: $message" "$(fit "$work/wrong.csv" "$work/gradients.csv")"
}
header=run,hours,fines_lost,conductance
refused 'another column' "wrong.csv:1: got the columns run,t; expected $header" run,t
refused 'no row' 'wrong.csv: got no row; expected at least one' $header
refused 'no number' "wrong.csv:2: fines_lost: got 'much'; expected a number from 0 to 100" $header constant,1,much,1
refused 'more than all' "wrong.csv:2: fines_lost: got '101'; expected a number from 0 to 100" $header constant,1,101,1
refused 'a cell too few' 'wrong.csv:2: got 3 cells; expected 4' $header constant,1,2
refused 'times that fall' \
  'wrong.csv:3: hours: got 1; expected times above 0 that ascend within a run' $header constant,2,3,1 constant,1,2,1
refused 'one point' "wrong.csv: got one point of 'constant'; two parameters cannot be fitted to fewer than two points" \
  $header constant,2,3,1
refused 'a run without gradients' "gradients.csv: got no row of 'other', which wrong.csv has" $header other,2,3,1
refused 'a point after the end' \
  'wrong.csv: constant: got a point at 13 h; expected none after 12 h, where its gradients end' $header constant,13,3,1
expect 'no such file' '2' "$(fit "$work/none.csv" "$work/gradients.csv" | cut -c1)"
expect 'a key that the scene does not know' '2' \
  "$(fit "$work/exact.csv" "$work/gradients.csv" --set soil.specimen.colour=red | cut -c1)"
finish laboratory

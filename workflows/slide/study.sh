#!/usr/bin/env bash
# The moment at which the levee loses its equilibrium, by mesh and tolerance, as CSV: study.sh PROGRAMS FOLDER.
set -eu -o pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
echo "size,tolerance,elements,steps,wall_seconds,failure_time"
for run in 0.7,1e-3 0.5,1e-3 0.35,1e-3 0.25,1e-3 0.5,1e-2 0.5,3e-4; do
  size=${run%,*} tolerance=${run#*,}
  stem=$2/size-$size-tolerance-$tolerance
  "$1/suffuse-mesher" ../examples/slide/slide.toml -o "$stem.case.h5" --set name=slide --set mesh.size="$size" \
    --set time.tolerance="$tolerance" --set time.failure=stop --set time.end=40000.0 --set 'output={every=500.0}' > /dev/null
  code=0
  "$1/suffuse-solver" "$stem.case.h5" -o "$stem.results" --force --quiet > "$stem.log" 2>&1 || code=$?
  # The run ends when the soil has lost its equilibrium; otherwise the time stays empty.
  case $code in
    0) failed= ;;
    3) failed=$(tail -1 "$stem.results/history.csv" | cut -d, -f1) ;;
    *) cat "$stem.log" >&2; exit "$code" ;;
  esac
  number() { sed -n "s/^ *\"$1\": \([0-9.e+-]*\),*$/\1/p" "$stem.results/run.json" | head -1; }
  echo "$run,$(number elements),$(number steps),$(number wall_seconds),$failed"
done

#!/usr/bin/env bash
# A calibration in OUT_FOLDER/fit/NAME/: fit.sh CALLED_FROM. make calls it, with its variables in the
# environment and itself as MAKE. The runs are a sweep, in the folder runs/.
set -eu -o pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. ./find_file.sh
if [ -z "$SCENE$MEASURED$KEYS" ]; then
  SCENE=fit/column.toml MEASURED=fit/column.csv AGAINST=
  KEYS=soil.sand.erosion.rate,soil.sand.erosion.threshold,soil.silt.erosion.rate,soil.silt.erosion.threshold
fi
scene=$(find_file SCENE "$1")
measured=$(find_file MEASURED "$1")
file=$(basename -- "$scene")
"$PYTHON" fit/fit.py "$scene" "$measured" "$OUT_FOLDER/fit/${NAME:-${file%.*}}" --keys "$KEYS" --against "$AGAINST" \
  --programs "$PROGRAMS"

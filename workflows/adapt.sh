#!/usr/bin/env bash
# Meshes a scene again and again until the discharge of its steady flow is known to mesh.error:
#
#     adapt.sh PROGRAMS SCENE STEM [--set KEY=VALUE]...
#
# Makes STEM.case.h5, and STEM.adapt.csv with a row for each mesh. Exit codes are those of the
# programs; 3 also if mesh.max_elements is not enough.
set -eu -o pipefail
programs=$1 scene=$2 stem=$3
shift 3
sizes=$stem.sizes.h5
trap 'rm -f "$sizes"' EXIT
most_meshes=20

echo "elements,flux_out,flux_out_low,flux_out_high" > "$stem.adapt.csv"
said=$("$programs/suffuse-mesher" "$scene" "$@" -o "$stem.case.h5")
for ((mesh = 1; mesh <= most_meshes; ++mesh)); do
  answer=$("$programs/suffuse-solver" "$stem.case.h5" --sizes "$sizes")
  echo "mesh $mesh: $answer"
  sed -nE 's/^Q = ([^ ]*) .*between ([^ ]*) and ([^ ]*) .*, ([0-9]*) elements$/\4,\1,\2,\3/p' <<< "$answer" \
    >> "$stem.adapt.csv"
  case $answer in
    *' is met'*)
      echo "$said"
      exit 0
      ;;
    *' is not met: mesh again'*) ;;
    *)
      tail -1 <<< "$answer" >&2
      exit 3
      ;;
  esac
  said=$("$programs/suffuse-mesher" "$scene" "$@" --sizes "$sizes" -o "$stem.case.h5")
done
echo "mesh.error is not met after $most_meshes meshes" >&2
exit 3

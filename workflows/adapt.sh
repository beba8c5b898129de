#!/usr/bin/env bash
# Meshes a scene again and again until its discharge is known to mesh.error:
#
#     adapt.sh [--over-run | --by-default] PROGRAMS SCENE STEM [--set KEY=VALUE]...
#
# Looks at the steady flow at the start of the scene. With --over-run it makes the run on each mesh
# and looks at the whole of it; STEM.results/ is that on the last mesh. --by-default is for a scene
# without mesh.error: where the mesher says that it has chosen mesh.size, mesh.error is 0.01, and what
# cannot be bounded or met stays as it is.
#
# Makes STEM.case.h5, and STEM.adapt.csv with a row for each mesh. Exit codes are those of the
# programs; 3 also if mesh.max_elements is not enough, or more elements hardly help: an estimate may
# hold more than the error of the mesh.
set -eu -o pipefail
mode=
case $1 in --*) mode=$1 && shift ;; esac
programs=$1 scene=$2 stem=$3
shift 3
changes=("$@")
sizes=$stem.sizes.h5 complaint=$stem.adapt.err
trap 'rm -f "$sizes" "$complaint"' EXIT
most_meshes=20

# mesh OPTION...: makes the case.
mesh() { said=$("$programs/suffuse-mesher" "$scene" "${changes[@]}" "$@" -o "$stem.case.h5"); }

# measure: how well the discharge is known on this mesh, in `answer`.
measure() {
  local from=()
  if [ "$mode" = --over-run ]; then
    "$programs/suffuse-solver" "$stem.case.h5" -o "$stem.results" --force --quiet || return
    from=(--from "$stem.results")
  fi
  answer=$("$programs/suffuse-solver" "$stem.case.h5" --sizes "$sizes" "${from[@]}")
}

# end CODE [MESSAGE]: what is not met by default is no failure.
end() {
  local code=$1 message=${2:-}
  if [ "$mode" = --by-default ] && { [ "$code" = 2 ] || [ "$code" = 3 ]; }; then
    echo "not meshed again: ${message#suffuse-solver: error: }"
    code=0
  elif [ -n "$message" ]; then
    echo "$message" >&2
  fi
  if [ "$code" = 0 ]; then echo "$said"; fi
  exit "$code"
}

# hardly_helped: this mesh has at least twice as many elements as an earlier one, and leaves 85 % of
# the interval or more.
hardly_helped() {
  tail -n +2 "$stem.adapt.csv" | awk -F, '
    { elements[NR] = $1; width[NR] = $4 - $3 }
    END {
      for (mesh = NR - 1; mesh > 0 && 2 * elements[mesh] > elements[NR]; --mesh) {}
      exit !(mesh > 0 && width[NR] > 0.85 * width[mesh])
    }'
}

mesh
if [ "$mode" = --by-default ] && [[ $said != *'mesh again until'* ]]; then end 0; fi
echo "elements,flux_out,flux_out_low,flux_out_high" > "$stem.adapt.csv"
for ((count = 1; count <= most_meshes; ++count)); do
  code=0
  measure 2> "$complaint" || code=$?
  if [ "$code" != 0 ]; then end "$code" "$(cat "$complaint")"; fi
  cat "$complaint" >&2
  echo "mesh $count: $answer"
  sed -nE 's/^Q = ([^ ]*) .*between ([^ ]*) and ([^ ]*) .*, ([0-9]*) elements$/\4,\1,\2,\3/p' <<< "$answer" \
    >> "$stem.adapt.csv"
  # With the key the run says how well its discharge is known.
  if [ "$mode" = --by-default ] && [ "$count" = 1 ]; then changes+=(--set mesh.error=0.01); fi
  case $answer in
    *' is met'*)
      if [ "$mode" = --by-default ] && [ "$count" = 1 ]; then mesh; fi
      end 0
      ;;
    *' is not met: mesh again'*)
      if hardly_helped; then end 3 "mesh.error is not met, and more elements hardly help: the case has the last mesh"; fi
      mesh --sizes "$sizes"
      ;;
    *) end 3 "$(tail -1 <<< "$answer")" ;;
  esac
done
end 3 "mesh.error is not met after $most_meshes meshes"

#!/bin/bash
# Lists the runs of a problem, one per line: SCHEME SIZE POINTS TOLERANCE KEY=VALUE..., coarse to
# fine within a scheme. `variants.sh PROBLEM short` lists the few of SHORT=1.
#
# SCHEME is FORMULATION-WAY: sp, dp in its default mode, or dp in the paper's mode (paper); scaled (explicit,
# mass scaling 1e4), explicit, drag (explicit, drag stepped implicitly) or implicit. POINTS are
# points per element: solid points for sp, liquid points at the start otherwise. TOLERANCE is - if
# there is none.
set -eu -o pipefail
problem=$1 form=${2:-full}

# As in Figs. 5 and 6 of the paper: see ../paper/variants.mk.
as_in_paper="points.seeding=gauss points.equal_volume=false soil.specimen.erosion.mass_transfer=element \
soil.specimen.erosion.empty_elements=dry"
# Only the explicit scheme can have its pressure at points.
at_points="flow.integration=material-point"

declare -A keys=(
  [sp]="formulation=single-point" [dp]="formulation=double-point" [paper]="formulation=double-point"
  [scaled]="time.scheme=explicit time.mass_scaling=1e4" [explicit]="time.scheme=explicit"
  [drag]="time.scheme=explicit time.drag=implicit" [implicit]="time.scheme=implicit"
)
declare -A sizes=(
  [fines-constant]="0.5 0.25 0.125 0.0625 0.03125 0.015625" [startup]="0.5 0.25 0.125"
  [feedback]="0.5 0.25 0.125" [dam]="0.8 0.4 0.2 0.1 0.05"
)
sizes[fines-log]=${sizes[fines-constant]}
sizes[porosity-gradient]=${sizes[fines-constant]}
declare -A points=([sp]=3 [dp]="12 3 48" [paper]="12 3")
tolerances="1e-3 1e-2 1e-4"
case $problem in
  startup) points=([sp]=3 [dp]=3 [paper]=3) ;;
  # The result does not depend on the places of the liquid points.
  feedback) points=([sp]=3 [dp]="12 3" [paper]="12 3") ;;
  dam) points=([sp]=3 [dp]="12 3" [paper]="12 3") ;;
esac
if [ "$form" == short ]; then
  case $problem in
    # The check judges times of this problem, so it has runs long enough to be timed.
    fines-constant) sizes[$problem]="0.25 0.125 0.0625" sizes[sp]="0.0625 0.03125" ;;
    dam) sizes[dam]="0.8 0.4" ;;
    *) sizes[$problem]="0.5 0.25" ;;
  esac
  points=([sp]=3 [dp]=3 [paper]=3)
  tolerances=1e-3
fi

# There, the error of the explicit schemes falls with the step, and the step with the size.
sizes[small-steps]="${sizes[startup]} 0.0625 0.03125 0.015625"

run() { # FORMULATION WAY SIZE POINTS TOLERANCE
  local more=
  [ "$1" == sp ] || more+=" points.liquid_per_element=$4"
  [ "$1" != paper ] || more+=" $as_in_paper"
  [ "$1-$2" == paper-implicit ] || [ "$1" != paper ] || more+=" $at_points"
  [ "$5" == - ] || more+=" time.tolerance=$5"
  # A problem in which nothing erodes has no exchange of mass.
  [ "$problem" != startup ] || more=$(tr ' ' '\n' <<< "$more" | grep -v erosion | tr '\n' ' ')
  echo "$1-$2 $3 $4 $5 mesh.size=$3 ${keys[$1]} ${keys[$2]}$more"
}

# sizes_of FORMULATION WAY COUNT TOLERANCE: all sizes for the usual points and tolerance. Only sp
# has the finest size. Other numbers of points leave out the two finest sizes, or the finest with
# the implicit scheme, because they are slow and show nothing more. So do other tolerances.
sizes_of() {
  local all=${sizes[$problem]} most=9 usual=${points[$1]%% *}
  [ "$problem-$form-$2" == startup-full-implicit ] || [ "$problem-$form" != startup-full ] || all=${sizes[small-steps]}
  if [ "$form" == short ]; then
    echo "${sizes[$1]:-$all}"
    return
  fi
  case $problem in
    fines-* | porosity-gradient)
      [ "$1" == sp ] || most=5
      [ "$3" == "$usual" ] && [ "$4" == - -o "$4" == "${tolerances%% *}" ] || most=4
      [ "$2" != implicit ] || [ "$3" == "$usual" ] || most=5
      # This tolerance is the one to choose for these problems.
      [ "$1 $4" != "sp 1e-2" ] || most=9
      ;;
    dam) [ "$3" == "$usual" ] && [ "$4" == - -o "$4" == "${tolerances%% *}" ] || most=4 ;;
  esac
  cut -d' ' -f1-$most <<< "$all"
}

for formulation in sp dp paper; do
  for way in scaled explicit drag implicit; do
    for count in ${points[$formulation]}; do
      # The stepping of drag does not depend on the points.
      [ $way != drag ] || [ "$count" == "${points[$formulation]%% *}" ] || continue
      settings=-
      # Other tolerances are run only with the usual number of points.
      [ $way != implicit ] || settings=${tolerances%% *}
      [ $way != implicit ] || [ "$count" != "${points[$formulation]%% *}" ] || settings=$tolerances
      for tolerance in $settings; do
        for size in $(sizes_of $formulation $way "$count" "$tolerance"); do
          run $formulation $way "$size" "$count" "$tolerance"
        done
      done
    done
  done
done

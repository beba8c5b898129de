#!/bin/bash
# The known values of a problem in the format of suffuse-post error: reference.sh PROBLEM >
# FILE.csv. Its numbers are those of PROBLEM.toml.
set -eu -o pipefail
cd "$(dirname "$0")"

# Fluidised grains at 6 and 12 s; a head of 5886 Pa over a bulk modulus of 2e7 Pa.
profile() { awk "$@" -v flux=0.012 -v expansion=2.943e-4 -v times="6 12" -f profile.awk; }

case $1 in
  fines-constant) profile -v law=constant -v rate=5e-3 ;;
  fines-log) profile -v law=logarithmic -v rate=1e-2 ;;
  porosity-gradient) profile -v law=constant -v rate=1e-3 -v n0=0.25 -v slope=0.1 ;;
  # Mean flux, (n P/(rho L)) tau (1 - exp(-t/tau)), downwards, tau = k/(n g), for any bulk modulus.
  startup) awk 'BEGIN {
      tau = 2e-2 / (0.3 * 9.81)
      print "t,mean_darcy_flux_y"
      for (k = 1; k <= 8; ++k) printf "%g,%.15g\n", 0.005 * k, -0.3 * 6 * tau * (1 - exp(-0.005 * k / tau))
    }' ;;
  # Under a constant head the mean flux is proportional to n^3/(1 - n)^2, n = 0.3 + 5e-3 (t - 2).
  feedback) awk 'function kozeny_carman(n) { return n ^ 3 / (1 - n) ^ 2 }
    BEGIN {
      print "t,mean_darcy_flux_y"
      for (t = 2; t <= 20; t += 2)
        printf "%g,%.15g\n", t, -0.0012 * kozeny_carman(0.3 + 5e-3 * (t - 2)) / kozeny_carman(0.3)
    }' ;;
  # A run on a finer mesh than those of all compared runs: make -C workflows accuracy-dam.
  dam) cat dam.csv ;;
  *) echo "reference.sh: got '$1'; expected a problem" >&2; exit 2 ;;
esac

#pragma once

/// The liquid: weakly compressible water that carries incompressible fluidised grains.

#include <cmath>

namespace suffuse {

/// p = K ln(rho_w / rho_w0), from the ratio rho_w / rho_w0.
inline double pressure_from_density_ratio(double ratio, double bulk_modulus) {
  return bulk_modulus * std::log(ratio);
}

/// rho_w / rho_w0 at a pressure.
inline double density_ratio(double pressure, double bulk_modulus) {
  return std::exp(pressure / bulk_modulus);
}

/// rho_L = (1 - c) rho_w + c rho_s, kg/m3.
inline double mixture_density(double concentration, double water_density, double grain_density) {
  return (1.0 - concentration) * water_density + concentration * grain_density;
}

}  // namespace suffuse

#pragma once

/// Drag of the soil on the liquid.

#include <cmath>

#include "physics/conductivity/conductivity_law.hpp"

namespace suffuse {

/// Acceleration of gravity that converts conductivity to drag; not that of the scene, m/s2.
inline constexpr double conductivity_gravity = 9.81;

/// Darcy drag on the liquid per mixture volume, divided by n_L: n_L rho_w g / k, in kg/(m3 s).
inline double darcy_drag(double porosity, double water_density, double conductivity) {
  return porosity * water_density * conductivity_gravity / conductivity;
}

/// Grain size for which Ergun's equation gives this conductivity at the initial porosity, m:
/// kappa = d^2 n^3 / (A (1 - n)^2), A = 150.
inline double ergun_grain_size(double conductivity, double initial_porosity, double water_density,
                               double viscosity) {
  const double permeability = conductivity * viscosity / (water_density * conductivity_gravity);
  const double n = initial_porosity;
  return (1.0 - n) * std::sqrt(150.0 * permeability / (n * n * n));
}

/// b in grad p = -(mu / kappa) q - b |q| q, kg/m4: B (1 - n) rho / (n^3 d), B = 1.75.
/// Ergun, Chem. Eng. Prog. 48 (1952) 89.
inline double ergun_quadratic_drag(double porosity, double water_density, double grain_size) {
  const double n = porosity;
  return 1.75 * (1.0 - n) * water_density / (n * n * n * grain_size);
}

}  // namespace suffuse

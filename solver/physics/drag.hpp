#pragma once

/// Drag of the soil on the liquid.

#include <cmath>

#include "case/scene.hpp"

namespace suffuse {

/// Acceleration of gravity that turns conductivity into drag, whatever gravity the scene has, m/s2.
inline constexpr double conductivity_gravity = 9.81;

/// Darcy drag on the liquid per mixture volume, divided by n_L: n_L rho_w g / k, in kg/(m3 s).
inline double darcy_drag(double porosity, double water_density, double conductivity) {
  return porosity * water_density * conductivity_gravity / conductivity;
}

/// KC(n) = n^3 / (1 - n)^2, to which Kozeny and Carman's conductivity is proportional: infinite
/// where there is no solid (Carman, Trans. Inst. Chem. Eng. 15 (1937) 150).
inline double kozeny_carman(double porosity) {
  const double solid = 1.0 - porosity;
  return porosity * porosity * porosity / (solid * solid);
}

/// k of a soil whose porosity has gone from `initial_porosity`, where k is `conductivity`, to
/// `porosity`, m/s.
inline double conductivity_at(ConductivityLaw law, double conductivity, double initial_porosity,
                              double porosity) {
  if (law == ConductivityLaw::constant) return conductivity;
  return conductivity * (kozeny_carman(porosity) / kozeny_carman(initial_porosity));
}

/// Grain size at which Ergun's equation has the given conductivity at the initial porosity, m:
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

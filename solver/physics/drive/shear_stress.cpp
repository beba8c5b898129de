/// The drive is the shear stress on the walls of the pores, taken as tubes of equal radius:
/// tau = rho_w g k_r i sqrt(2 kappa / n_L) (Khilar, Fogler and Gray, J. Geotech. Eng. 111 (1985)
/// 833; Reddi, Lee and Bonala, Geotech. Test. J. 23 (2000) 62).

#include <cmath>

#include "physics/drive/drive_law.hpp"

namespace suffuse::drive {
namespace {

double value(const LocalState& state) {
  return state.unit_weight * state.drag_gradient *
         std::sqrt(2.0 * state.permeability / state.porosity);
}

}  // namespace

extern const DriveLaw shear_stress{.word = "shear-stress",
                                   .equation = "tau = rho_w g k_r i sqrt(2 kappa / n_L)",
                                   .symbol = "tau",
                                   .unit = "Pa",
                                   .rate_unit = "1/(Pa s)",
                                   .depends_on_conductivity = true,
                                   .value = value};

}  // namespace suffuse::drive

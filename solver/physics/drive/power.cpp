/// The drive is the power that the flow dissipates per volume of soil: P = rho_w g k_r i |q|
/// (Sibille, Marot and Sail, Acta Geotech. 10 (2015) 489).

#include "physics/drive/drive_law.hpp"

namespace suffuse::drive {
namespace {

double value(const LocalState& state) {
  return state.unit_weight * state.drag_gradient * state.flux;
}

}  // namespace

extern const DriveLaw power{.word = "power",
                            .equation = "P = rho_w g k_r i |q|",
                            .symbol = "P",
                            .unit = "W/m3",
                            .rate_unit = "m3/J",
                            .depends_on_conductivity = true,
                            .value = value};

}  // namespace suffuse::drive

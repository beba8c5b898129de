/// The drive is the hydraulic gradient along the flow: D = k_r i, equal to |q|/k for Darcy's drag.

#include "physics/drive/drive_law.hpp"

namespace suffuse::drive {
namespace {

double value(const LocalState& state) {
  return state.drag_gradient;
}

}  // namespace

extern const DriveLaw gradient{.word = "gradient",
                               .equation = "k_r i, i the hydraulic gradient along the flow",
                               .symbol = "k_r i",
                               .unit = "1",
                               .rate_unit = "1/s",
                               .depends_on_conductivity = true,
                               .value = value};

}  // namespace suffuse::drive

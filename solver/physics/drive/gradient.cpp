/// Erosion goes with the hydraulic gradient along the flow: D = i, |q|/k where drag is Darcy's.

#include "physics/drive/drive_law.hpp"

namespace suffuse::drive {
namespace {

double value(const LocalState& state) {
  return state.drag_gradient;
}

}  // namespace

extern const DriveLaw gradient{.word = "gradient",
                               .equation = "i, the hydraulic gradient along the flow",
                               .symbol = "i",
                               .unit = "1",
                               .rate_unit = "1/s",
                               .depends_on_conductivity = true,
                               .value = value};

}  // namespace suffuse::drive

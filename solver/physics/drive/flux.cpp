/// The drive is the flux of the liquid: D = |q| (Cividini and Gioda, Int. J. Geomech. 4 (2004)
/// 191).

#include "physics/drive/drive_law.hpp"

namespace suffuse::drive {
namespace {

double value(const LocalState& state) {
  return state.flux;
}

}  // namespace

extern const DriveLaw flux{.word = "flux",
                           .equation = "|q|",
                           .symbol = "|q|",
                           .unit = "m/s",
                           .rate_unit = "1/m",
                           .value = value};

}  // namespace suffuse::drive

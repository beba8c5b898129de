#include "physics/viscosity/viscosity_law.hpp"

#include <algorithm>
#include <limits>

namespace suffuse {

double ViscosityModel::ratio(double concentration) const {
  if (!depends_on_concentration()) return 1.0;
  if (concentration >= maximum_concentration) return std::numeric_limits<double>::infinity();
  return law->ratio(std::max(concentration, 0.0), maximum_concentration);
}

}  // namespace suffuse

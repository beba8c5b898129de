#include "checks/eurocode.hpp"

#include <limits>

namespace suffuse {

double Utilisation::factor() const {
  return effect > 0.0 ? resistance / effect : std::numeric_limits<double>::infinity();
}

Utilisation heave_by_stresses(const ColumnLoads& column, const PartialFactors& factors) {
  return {factors.destabilising * column.pressure, factors.stabilising * column.total_stress};
}

Utilisation heave_by_forces(const ColumnLoads& column, const PartialFactors& factors) {
  return {factors.destabilising * column.seepage_force, factors.stabilising * column.weight};
}

Utilisation uplift(const ColumnLoads& column, const PartialFactors& factors) {
  return heave_by_stresses(column, factors);
}

}  // namespace suffuse

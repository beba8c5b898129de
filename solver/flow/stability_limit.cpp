#include "flow/stability_limit.hpp"

#include <cmath>
#include <limits>

namespace suffuse {

double stable_step(double omega, double damping, DragIntegration drag) {
  const double root = std::sqrt(damping * damping + 4.0 * omega * omega);
  // The explicit form as 4 / (root + a): the difference root - a cancels for strong drag.
  if (drag == DragIntegration::explicit_drag) return 4.0 / (root + damping);
  return (damping + root) / (omega * omega);
}

template <int Dim>
StabilityLimit stability_limit(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                               const std::vector<double>& carried_porosity, double bulk_modulus,
                               double mass_scaling, DragIntegration drag) {
  StabilityLimit limit{std::numeric_limits<double>::infinity(), -1};
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    double sum = 0.0;
    for (int k = 0; k <= Dim; ++k) {
      sum += carried_porosity[grid.mesh.elements[e][k]] * grid.shape_gradient[e][k].squaredNorm();
    }
    const double mass = coefficients.mixture_density[e] * mass_scaling;
    const double water_fraction = coefficients.water_volume[e] / grid.volume[e];
    const double omega = std::sqrt((Dim + 1) * bulk_modulus / mass * sum / water_fraction);
    const double step = stable_step(omega, coefficients.drag[e] / mass, drag);
    if (step < limit.step) limit = {step, e};
  }
  return limit;
}

template StabilityLimit stability_limit(const Grid<2>&, const FlowCoefficients<2>&,
                                        const std::vector<double>&, double, double,
                                        DragIntegration);

}  // namespace suffuse

#include "flow/stability_limit.hpp"

#include <algorithm>
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
                               double mass_scaling, DragIntegration drag,
                               const std::vector<double>& node_speed) {
  StabilityLimit limit{std::numeric_limits<double>::infinity(), -1};
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const bool explicit_drag = drag == DragIntegration::explicit_drag;
    double sum = 0.0;
    double drag_at_worst = explicit_drag ? 0.0 : std::numeric_limits<double>::infinity();
    for (int k = 0; k <= Dim; ++k) {
      const int i = grid.mesh.elements[e][k];
      const double n = carried_porosity[i];
      sum += n * grid.shape_gradient[e][k].squaredNorm();
      double node_drag = n * coefficients.drag[e] / coefficients.porosity[e];
      if (!coefficients.quadratic_drag.empty() && !node_speed.empty()) {
        // The slope of b |q| q is twice its secant, on which an implicit step stands.
        node_drag +=
            (explicit_drag ? 2.0 : 1.0) * coefficients.quadratic_drag[e] * n * n * node_speed[i];
      }
      drag_at_worst =
          explicit_drag ? std::max(drag_at_worst, node_drag) : std::min(drag_at_worst, node_drag);
    }
    const double mass = coefficients.mixture_density[e] * mass_scaling;
    const double water_fraction = coefficients.water_volume[e] / grid.volume[e];
    const double omega = std::sqrt((Dim + 1) * bulk_modulus / mass * sum / water_fraction);
    const double step = stable_step(omega, drag_at_worst / mass, drag);
    if (step < limit.step) limit = {step, e};
  }
  return limit;
}

template StabilityLimit stability_limit(const Grid<2>&, const FlowCoefficients<2>&,
                                        const std::vector<double>&, double, double, DragIntegration,
                                        const std::vector<double>&);

}  // namespace suffuse

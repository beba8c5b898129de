#include "explicit/locking.hpp"

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"
#include "grid/face_flux.hpp"
#include "mixed/implicit_mixed.hpp"

namespace suffuse {
namespace {

/// Flux that prescribed values and gravity could drive through one element; at rest the flux is
/// small compared with it.
template <int Dim>
double drivable_flux(const NodalOperator<Dim>& op, const FlowCoefficients<Dim>& coefficients) {
  const Grid<Dim>& grid = op.grid();
  double pressure = 0.0;
  double prescribed = 0.0;
  for (const FaceCondition& condition : op.conditions()) {
    if (condition.kind == FaceKind::pressure) {
      pressure = std::max(pressure, std::abs(condition.value));
    } else if (condition.fixes_flux()) {
      prescribed = std::max(prescribed, std::abs(condition.value));
    }
  }
  double driven = 0.0;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const double mobility = coefficients.porosity[e] / coefficients.drag[e];
    const double size = std::pow(grid.volume[e], 1.0 / Dim);
    driven = std::max(driven, mobility * (pressure / size +
                                          coefficients.mixture_density[e] * op.gravity().norm()));
  }
  return driven + prescribed;
}

}  // namespace

template <int Dim>
std::optional<double> deviation_from_mixed_flow(const NodalOperator<Dim>& op,
                                                const FlowCoefficients<Dim>& coefficients,
                                                const VectorField<Dim>& velocity) {
  const Grid<Dim>& grid = op.grid();
  std::vector<Vector<Dim>> mixed;
  try {
    ImplicitMixed<Dim> scheme(grid, {}, op.gravity());
    mixed = element_flux(grid, scheme.steady({coefficients, op.conditions(), {}}).face_flux);
  } catch (const NumericalError&) {
    return std::nullopt;  // Prescribed fluxes that do not balance have no steady flow.
  }
  double difference = 0.0;
  double scale = 0.0;
  double volume = 0.0;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    Vector<Dim> flux = Vector<Dim>::Zero();
    for (const int i : grid.mesh.elements[e]) {
      flux += op.node_porosity()[i] * velocity[i] / (Dim + 1);
    }
    difference += grid.volume[e] * (flux - mixed[e]).squaredNorm();
    scale += grid.volume[e] * mixed[e].squaredNorm();
    volume += grid.volume[e];
  }
  const double rest = 1e-9 * drivable_flux(op, coefficients);
  if (scale <= rest * rest * volume) return std::nullopt;
  return std::sqrt(difference / scale);
}

template std::optional<double> deviation_from_mixed_flow(const NodalOperator<2>&,
                                                         const FlowCoefficients<2>&,
                                                         const VectorField<2>&);

}  // namespace suffuse

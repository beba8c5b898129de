#include "flow/steady_reuse.hpp"

#include <algorithm>
#include <cmath>

#include "grid/field_values.hpp"
#include "mixed/implicit_thresholds.hpp"

namespace suffuse {

template <int Dim>
bool boundary_values_rest(const Grid<Dim>& grid, const BoundaryValues<Dim>& values,
                          const std::vector<FaceCondition>& conditions, double time, double end) {
  if (!values.vary()) return true;
  // Values are linear between two kinks: constant if equal at both.
  std::vector<FaceCondition> later = conditions;
  const auto next = std::upper_bound(values.breakpoints().begin(), values.breakpoints().end(),
                                     time * (1.0 + 1e-14));
  values.update(next != values.breakpoints().end() ? *next : end, later);
  const bool rest =
      std::ranges::equal(later, conditions, {}, &FaceCondition::value, &FaceCondition::value);
  return !any_of_all(grid.ranks(), !rest);
}

template <int Dim>
void SteadyReuse<Dim>::check(const FlowCoefficients<Dim>& coefficients) {
  if (!coefficients_) return;
  if (any_of_all(grid_.ranks(), !resists_alike(coefficients, *coefficients_))) stop();
}

template <int Dim>
bool SteadyReuse<Dim>::is_close(const std::vector<double>& a, const std::vector<double>& b,
                                double scale) const {
  const double largest = largest_of_all(grid_.ranks(), largest_difference(a, b));
  return largest <= implicit_thresholds.steady * settings_.tolerance * scale;
}

template <int Dim>
bool SteadyReuse<Dim>::needs_update(const std::vector<double>& source,
                                    const std::vector<double>& new_source,
                                    double flux_scale) const {
  double together = 0.0;
  // Relaxation has no sources yet in all elements, or in none.
  if (!source.empty()) {
    for (const int e : grid_.own_elements()) together += std::abs(new_source[e] - source[e]);
  }
  return sum_of_all(grid_.ranks(), together) >
         implicit_thresholds.steady_update * settings_.tolerance * flux_scale;
}

template <int Dim>
bool SteadyReuse<Dim>::resists_alike(const FlowCoefficients<Dim>& a,
                                     const FlowCoefficients<Dim>& b) const {
  const auto same = [](double x, double y) {
    return std::abs(x - y) <= implicit_thresholds.resistance_round_off * std::abs(y);
  };
  for (std::size_t e = 0; e < a.drag.size(); ++e) {
    if (!same(a.drag[e] / a.porosity[e], b.drag[e] / b.porosity[e])) return false;
    if (settings_.has_gravity && !same(a.mixture_density[e], b.mixture_density[e])) return false;
    if (settings_.prescribes_velocity && !same(a.porosity[e], b.porosity[e])) return false;
    if (!a.quadratic_drag.empty() && !same(a.quadratic_drag[e], b.quadratic_drag[e])) return false;
  }
  return true;
}

template bool boundary_values_rest(const Grid<2>&, const BoundaryValues<2>&,
                                   const std::vector<FaceCondition>&, double, double);
template class SteadyReuse<2>;
template bool boundary_values_rest(const Grid<3>&, const BoundaryValues<3>&,
                                   const std::vector<FaceCondition>&, double, double);
template class SteadyReuse<3>;

}  // namespace suffuse

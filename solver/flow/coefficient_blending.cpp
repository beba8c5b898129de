#include "flow/coefficient_blending.hpp"

#include <algorithm>
#include <cmath>

#include "mixed/implicit_thresholds.hpp"

namespace suffuse {

template <int Dim>
void CoefficientBlending<Dim>::blend(double elapsed, const FlowCoefficients<Dim>& now,
                                     FlowCoefficients<Dim>& coefficients) const {
  for (std::size_t e = 0; e < density_drift_.size(); ++e) {
    double& density = coefficients.mixture_density[e];
    density = std::clamp(density + density_drift_[e] * elapsed, settings_.min_density,
                         settings_.max_density);
  }
  const double share = 1.0 - elapsed / blend_time_;
  if (!settings_.blend || used_.porosity.empty() || !(share > 0.0)) return;
  const auto blend_values = [&](const std::vector<double>& before, const std::vector<double>& after,
                                std::vector<double>& values) {
    for (std::size_t e = 0; e < values.size(); ++e) {
      if (after[e] > 0.0) values[e] *= 1.0 + share * (before[e] / after[e] - 1.0);
    }
  };
  blend_values(used_.water_volume, now.water_volume, coefficients.water_volume);
  if (!settings_.all) return;
  blend_values(used_.mixture_density, now.mixture_density, coefficients.mixture_density);
  blend_values(used_.porosity, now.porosity, coefficients.porosity);
  blend_values(used_.drag, now.drag, coefficients.drag);
  blend_values(used_.quadratic_drag, now.quadratic_drag, coefficients.quadratic_drag);
}

template <int Dim>
double CoefficientBlending<Dim>::learn(const Grid<Dim>& grid, const FlowCoefficients<Dim>& now,
                                       double dt, double weight,
                                       const std::vector<double>& losses) {
  if (!expected_) return 0.0;
  double error = 0.0;
  double all_losses = 0.0;
  double lost = 0.0;
  density_drift_.resize(now.drag.size(), 0.0);
  for (std::size_t e = 0; e < now.drag.size(); ++e) {
    const double drift = (now.mixture_density[e] - expected_->mixture_density[e]) / dt;
    density_drift_[e] += weight * (drift - density_drift_[e]);
    const double resistance = expected_->drag[e] / expected_->porosity[e];
    const double own = std::abs(resistance * now.porosity[e] / now.drag[e] - 1.0);
    error = std::max(error, own);
    if (losses.empty() || !grid.element_rows().owns(static_cast<int>(e))) continue;
    all_losses += losses[e];
    lost += losses[e] * own;
  }
  expected_.reset();
  all_losses = sum_of_all(grid.ranks(), all_losses);
  if (all_losses > 0.0) return sum_of_all(grid.ranks(), lost) / all_losses;
  return largest_of_all(grid.ranks(), error);
}

template <int Dim>
void CoefficientBlending<Dim>::finish(double dt) {
  blend_time_ = std::max(dt, blend_time_ - implicit_thresholds.fading * dt);
}

template <int Dim>
void CoefficientBlending<Dim>::shorten(double dt) {
  blend_time_ = std::min(blend_time_, implicit_thresholds.breakpoint_blending * dt);
}

template class CoefficientBlending<2>;
template class CoefficientBlending<3>;

}  // namespace suffuse

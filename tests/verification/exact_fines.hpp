#pragma once

/// Fluidised fines in a column that clean water enters at uniform Darcy flux q, by characteristics:
/// D ln(1 - c)/Dt = -phi_e / n_L along a path of the liquid. It is integrated with small steps from
/// the law and the initial porosity, independently of the solver.

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace suffuse {

/// Uniform porosity: c = 1 - n(t_in) / n(t), with t_in from x = integral of q/n over (t_in, t).
class UniformFines {
 public:
  UniformFines(const std::function<double(double)>& rate, double porosity, double porosity_max,
               double start, double flux, double end)
      : start_(start) {
    const auto capped = [&](double n) { return n < porosity_max ? rate(n) : 0.0; };
    double n = porosity;
    double path = 0.0;
    porosity_.push_back(n);
    path_.push_back(path);
    for (double t = start; t < end + step; t += step) {
      const double k1 = capped(n);
      const double k2 = capped(n + 0.5 * step * k1);
      const double k3 = capped(n + 0.5 * step * k2);
      const double k4 = capped(n + step * k3);
      const double next = std::min(porosity_max, n + step / 6.0 * (k1 + 2 * k2 + 2 * k3 + k4));
      path += step * flux * 0.5 * (1.0 / n + 1.0 / next);
      n = next;
      porosity_.push_back(n);
      path_.push_back(path);
    }
  }

  [[nodiscard]] double porosity(double t) const { return at(porosity_, (t - start_) / step); }

  /// \param x from the inlet
  [[nodiscard]] double concentration(double x, double t) const {
    if (t <= start_) return 0.0;
    const double entered = at(path_, (t - start_) / step) - x;
    double position = 0.0;  // the water was in the column before erosion began
    if (entered > 0.0) {
      const auto above = std::upper_bound(path_.begin(), path_.end(), entered);
      const auto i = static_cast<double>(above - path_.begin());
      position = i - (*above - entered) / (*above - *(above - 1));
    }
    return 1.0 - at(porosity_, position) / porosity(t);
  }

 private:
  static constexpr double step = 1e-3;
  [[nodiscard]] static double at(const std::vector<double>& values, double position) {
    const double clamped = std::clamp(position, 0.0, static_cast<double>(values.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(clamped), values.size() - 2);
    return values[i] + (clamped - static_cast<double>(i)) * (values[i + 1] - values[i]);
  }

  double start_;
  std::vector<double> porosity_;
  std::vector<double> path_;  ///< path of liquid since the start of erosion, m
};

/// For any porosity n(x, t) and rate phi(x, t) in closed form: the path is followed back from (x,
/// t) to the inlet or to the start of erosion.
inline double concentration_along_path(const std::function<double(double, double)>& porosity,
                                       const std::function<double(double, double)>& rate,
                                       double start, double flux, double x, double t) {
  if (t <= start) return 0.0;
  const int steps = 4000;
  const double h = (t - start) / steps;
  double logarithm = 0.0;
  double place = x;
  double time = t;
  for (int s = 0; s < steps; ++s) {
    const double halfway = std::max(0.0, place - 0.5 * h * flux / porosity(place, time));
    const double n = porosity(halfway, time - 0.5 * h);
    const double share = std::min(1.0, place / (h * flux / n));
    logarithm += share * h * rate(halfway, time - 0.5 * h) / n;
    place -= share * h * flux / n;
    time -= share * h;
    if (share < 1.0) break;
  }
  return -std::expm1(-logarithm);
}

}  // namespace suffuse

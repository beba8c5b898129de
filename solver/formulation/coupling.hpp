#pragma once

/// When flow, which takes many small steps, next meets erosion and transport.

#include <algorithm>
#include <cmath>

#include "solid/rigid_skeleton.hpp"

namespace suffuse {

/// Share of its limit that a transport step takes.
inline constexpr double transport_safety = 0.9;

/// Share of an interval in which nothing happens: looks closer together see the same.
inline constexpr double no_time = 1e-12;

/// A look there sees what the interval has come to, however often there were looks on the way.
inline bool is_end(double time, double begin, double duration) {
  return time - begin >= (1.0 - no_time) * duration;
}

/// Steps of transport over an interval of which one step may take the share `allowed` (safety
/// included). Intervals are often cut to a whole number of them: a share that is off by little, as
/// the flow may be, must not ask for one more. The safety has room for it.
inline double transport_substeps(double allowed) {
  constexpr double little = 0.01;
  return std::max(1.0, std::ceil((1.0 - little) / allowed));
}

/// Flow steps of `dt` until the next meeting: as many as transport allows (`transport_steps`), with
/// porosity growing by no more than `most_growth` of itself until the flow learns of it, at most a
/// thousand and at most twice the `last` ones: the flow may have grown since. `element_flux`: |q|,
/// m/s.
template <int Dim>
long steps_to_meeting(const RigidSkeleton<Dim>& skeleton,
                      const std::vector<double>& element_porosity,
                      const std::vector<double>& element_flux, double time, double dt,
                      double transport_steps, double most_growth, long last) {
  constexpr long most_steps = 1000;
  double allowed = transport_safety * transport_steps;
  for (std::size_t e = 0; e < element_porosity.size(); ++e) {
    const ErosionModel& model = skeleton.erosion_of_element(static_cast<int>(e));
    const double rate =
        erosion_rate(model, element_porosity[e], std::max(time, model.start), element_flux[e]);
    if (rate > 0.0) allowed = std::min(allowed, most_growth * element_porosity[e] / (rate * dt));
  }
  const long most = std::min(most_steps, 2 * last);
  return std::max(1L, allowed < static_cast<double>(most) ? static_cast<long>(allowed) : most);
}

}  // namespace suffuse

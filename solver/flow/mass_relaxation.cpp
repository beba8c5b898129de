#include "flow/mass_relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "grid/field_values.hpp"
#include "mixed/implicit_thresholds.hpp"

namespace suffuse {

void MassRelaxation::observe(std::vector<double> mismatch, const std::vector<double>& volume) {
  const std::size_t elements = mismatch.size();
  if (outflow_.empty()) outflow_.assign(elements, 0.0);
  if (source_.empty()) source_.assign(elements, 0.0);
  if (change_time_ > 0.0 && active()) {
    // The source also removes the growth of the mismatch, which the next step would repeat.
    // Round-off is left out, as it would be a large rate over a short step.
    for (std::size_t e = 0; e < elements; ++e) {
      const double growth = mismatch[e] - mismatch_[e];
      const double round_off =
          implicit_thresholds.volume_round_off * (volume[e] + std::abs(mismatch[e]));
      const double certain = std::copysign(std::max(0.0, std::abs(growth) - round_off), growth);
      outflow_[e] = certain / change_time_ + source_[e];
    }
  }
  mismatch_ = std::move(mismatch);
}

std::vector<double> MassRelaxation::wanted_source(double dt, double filling_time) const {
  std::vector<double> source = outflow_;
  if (change_time_ > 0.0) {
    // A short step says little about a much longer one: parts of its growth, as that of soil whose
    // points change elements, do not grow with the step.
    const double known = std::min(1.0, implicit_thresholds.max_growth * change_time_ / dt);
    for (double& outflow : source) outflow *= known;
  }
  const double rate = 1.0 / std::max(implicit_thresholds.release_steps * dt, filling_time);
  for (std::size_t e = 0; e < mismatch_.size(); ++e) source[e] += rate * mismatch_[e];
  return source;
}

std::vector<double> MassRelaxation::released(double dt, double filling_time) const {
  std::vector<double> result = mismatch_;
  const double share = dt / std::max(implicit_thresholds.release_steps * dt, filling_time);
  for (double& volume : result) volume *= share;
  return result;
}

std::vector<double> MassRelaxation::next_source(double dt, double filling_time) const {
  return between(source_, wanted_source(dt, filling_time), std::min(1.0, dt / blending_time_));
}

void MassRelaxation::finish(double dt, double filling_time) {
  change_time_ = std::max(dt, change_time_ - implicit_thresholds.fading * dt);
  // The time falls by lengths of steps: a short peak of the flow hardly shortens it.
  const double counted = std::min(dt, implicit_thresholds.expansion_time * filling_time);
  blending_time_ = std::max(counted, blending_time_ - implicit_thresholds.fading * dt);
}

}  // namespace suffuse

#pragma once

/// Moves excess water out of the elements over several steps. Masses are stored, and the pressures
/// of a linear step satisfy the equation of state only nearly: an element then holds more or less
/// water than its pores take at its pressure. The next steps get this mismatch as a source, in m3/s
/// per element (positive: water leaves):
///
///   source = outflow that keeps the mismatch from growing
///          + mismatch / max(4 dt, time in which the flow fills an element)
///
/// If steps are equal, each step leaves 3/4 of a mismatch.

#include <utility>
#include <vector>

#include "results/state_archive.hpp"

namespace suffuse {

class MassRelaxation {
 public:
  /// `mismatch`: excess volume of water per element after the last step, m3; `volume`: of all its
  /// water, m3.
  void observe(std::vector<double> mismatch, const std::vector<double>& volume);
  /// Whether a mismatch has been observed; without one there is no source.
  [[nodiscard]] bool active() const { return !mismatch_.empty(); }

  /// The source that removes the mismatch in steps of `dt`, m3/s per element. `filling_time`: in
  /// which the largest flux fills the smallest element, s; infinite at rest.
  [[nodiscard]] std::vector<double> wanted_source(double dt, double filling_time) const;
  /// Volume by which the mismatch falls in such a step, m3 per element; empty if none was observed.
  [[nodiscard]] std::vector<double> released(double dt, double filling_time) const;
  /// The source of the next step: the wanted one, or part of the change towards it if the step is
  /// shorter than recent ones. A change that does not shrink with the step would be a jump, and no
  /// step is short enough for a jump. The length of recent steps is bounded by that from which
  /// `ImplicitFlow::let_out_expansion` finds the sources.
  [[nodiscard]] std::vector<double> next_source(double dt, double filling_time) const;

  /// The source of the last step, m3/s per element; empty until a mismatch has been observed.
  [[nodiscard]] const std::vector<double>& source() const { return source_; }
  /// Sets the source in effect.
  void set_source(std::vector<double> source) { source_ = std::move(source); }
  /// Call at a kink: the growth of the mismatch is measured in later steps only.
  void pass_kink() { change_time_ = 0.0; }
  /// Call after a step of `dt` seconds; its last flow fills an element in `filling_time`.
  void finish(double dt, double filling_time);

  void archive(auto& archive) {
    archive(on_elements(mismatch_), on_elements(outflow_), on_elements(source_), change_time_,
            blending_time_);
  }

 private:
  std::vector<double> mismatch_;  ///< excess water per element, m3
  std::vector<double> outflow_;   ///< that keeps it from growing (moving water expands), m3/s
  std::vector<double> source_;    ///< of the last step, m3/s
  double change_time_ = 0.0;      ///< over which the mismatch grew: the last step, or longer, s
  double blending_time_ = 0.0;    ///< in which the source changes, s
};

}  // namespace suffuse

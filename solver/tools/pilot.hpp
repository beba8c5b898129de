#pragma once

/// Explores the rest of a run. A pilot computes it in steps that are much longer than the run's
/// own; their errors give the length of the run's own steps. A few of these are tried at some
/// places of the pilot to measure their cost.

#include <cstdint>
#include <optional>
#include <vector>

#include "formulation/two_phase_model.hpp"
#include "tools/trial_course.hpp"

namespace suffuse {

template <int Dim>
class Pilot {
 public:
  /// Starts from the state of `model`, which must outlive the pilot; it is used to try steps.
  Pilot(const Case<Dim>& c, const ModelOptions& options, TwoPhaseModel<Dim>& model);

  /// Extends `course` from the state of the model to the time that the pilot reaches. Takes
  /// `seconds` of wall time; `each` is the cost of a step of the run so far, s.
  void look_ahead(double seconds, double each, TrialCourse& course);
  /// Number of steps that the pilot has taken.
  [[nodiscard]] long steps() const { return static_cast<long>(steps_.size()); }

 private:
  struct Step {
    double end = 0.0;    ///< s
    double count = 0.0;  ///< number of the run's own steps for this step
  };
  /// A time of the run at which its own steps may be tried.
  struct Place {
    std::size_t index = 0;  ///< of the pilot's step that ends there
    std::vector<std::uint8_t> state;
    double step = 0.0;     ///< length of the run's own steps, s
    double seconds = 0.0;  ///< wall time per step; 0 until it has been tried
  };

  /// Continues towards the end for at most `seconds` of wall time, with errors of steps below
  /// `tolerance`. `count`: approximate number of steps; nothing: steps as long as the tolerance
  /// allows.
  void travel(double tolerance, std::optional<double> count, double seconds);
  void note_step(TwoPhaseModel<Dim>& model, double start);
  [[nodiscard]] bool has_arrived() const { return time_ >= case_.document.scene.time.end; }
  /// Tries steps at the places for `seconds` of wall time, the most useful places first.
  void try_steps(double seconds);
  void try_steps_at(Place& place);

  const Case<Dim>& case_;
  ModelOptions options_;
  TwoPhaseModel<Dim>& model_;
  double time_;  ///< reached by the pilot, s
  std::vector<std::uint8_t> state_;
  std::vector<Step> steps_;
  std::size_t smooth_steps_ = 0;  ///< number of first steps, which kept a tolerance
  std::vector<Place> places_;     ///< the ends of every `stride_`-th step
  std::size_t stride_ = 1;
};

}  // namespace suffuse

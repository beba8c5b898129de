#pragma once

/// Looks ahead in a run. A pilot goes through it in steps that are much longer than the run's own;
/// their errors tell how long those will be. At some of the places where the pilot has been a few
/// of the run's own steps are tried, which tells what they cost.

#include <cstdint>
#include <optional>
#include <vector>

#include "formulation/two_phase_model.hpp"
#include "tools/trial_course.hpp"

namespace suffuse {

template <int Dim>
class Pilot {
 public:
  /// Starts from the state of `model`, which must outlive it and is used to try steps.
  Pilot(const Case<Dim>& c, const ModelOptions& options, TwoPhaseModel<Dim>& model);

  /// Continues the course with what lies between the state of the model and the place that the
  /// pilot reaches. Takes `seconds` of wall time; `each` is what a step of the run has cost so far.
  void look_ahead(double seconds, double each, TrialCourse& course);
  /// Steps that the pilot has taken.
  [[nodiscard]] long steps() const { return static_cast<long>(steps_.size()); }

 private:
  struct Step {
    double end = 0.0;    ///< s
    double count = 0.0;  ///< of the run's own steps meanwhile
  };
  /// A place where the run's own steps may be tried.
  struct Place {
    std::size_t index = 0;  ///< of the pilot's step that ends there
    std::vector<std::uint8_t> state;
    double step = 0.0;     ///< length of the run's own steps, s
    double seconds = 0.0;  ///< of wall time per step; 0 while it has not been tried
  };

  /// Goes on towards the end, for at most so many seconds of wall time. The error of each step is
  /// below `tolerance`. `count`: about how many steps; nothing for steps as long as the tolerance
  /// allows.
  void travel(double tolerance, std::optional<double> count, double seconds);
  void note_step(TwoPhaseModel<Dim>& model, double start);
  [[nodiscard]] bool has_arrived() const { return time_ >= case_.document.scene.time.end; }
  /// Tries steps at the places for so many seconds, in the order of what they tell.
  void try_steps(double seconds);
  void try_steps_at(Place& place);

  const Case<Dim>& case_;
  ModelOptions options_;
  TwoPhaseModel<Dim>& model_;
  double time_;  ///< that the pilot has reached, s
  std::vector<std::uint8_t> state_;
  std::vector<Step> steps_;
  std::size_t smooth_steps_ = 0;  ///< the first ones, which kept a tolerance
  std::vector<Place> places_;     ///< the ends of every `stride_`-th step
  std::size_t stride_ = 1;
};

}  // namespace suffuse

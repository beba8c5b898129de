#pragma once

/// From the start of a model to its end, interval by interval, with a look at each time of output.

#include "output_times.hpp"

namespace suffuse {

/// `Model` is SinglePoint or DoublePoint. Calls `output(state, moment, due)` at the start and at
/// each time at which something is to be written.
template <class Model>
class StepLoop {
 public:
  StepLoop(const Scene& scene, Model& model) : scene_(scene), model_(model), schedule_(scene) {}

  [[nodiscard]] bool finished() const { return schedule_.finished(); }
  [[nodiscard]] const OutputSchedule& schedule() const { return schedule_; }

  template <class Output>
  void start(const Output& output) {
    look(model_.state(), model_.moment(), output);
  }

  /// One interval of the model. Returns how many times of output lay in it.
  template <class Output>
  long advance(const Output& output) {
    const double target = scene_.output.exact ? schedule_.next() : scene_.time.end;
    const auto observations =
        model_.advance(target, [this](double reached) { return schedule_.times_until(reached); });
    for (const auto& [state, flow] : observations) look(state, flow, output);
    return static_cast<long>(observations.size());
  }

 private:
  template <class State, class Moment, class Output>
  void look(const State& state, const Moment& moment, const Output& output) {
    output(state, moment, schedule_.take(moment.time));
  }

  const Scene& scene_;
  Model& model_;
  OutputSchedule schedule_;
};

}  // namespace suffuse

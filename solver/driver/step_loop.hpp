#pragma once

/// From the start of a model to its end, interval by interval, with a look at each time of output.

#include <vector>

#include "driver/output_schedule.hpp"

namespace suffuse {

/// `Model` is SinglePoint or DoublePoint. Calls `output(looks)` at the start and after each
/// interval in which something is to be written.
template <class Model>
class StepLoop {
 public:
  /// The model at a time of output.
  struct Look {
    const typename Model::State& state;
    const typename Model::Moment& flow;
    OutputSchedule::Due due;
  };

  StepLoop(const Scene& scene, Model& model) : scene_(scene), model_(model), schedule_(scene) {}

  [[nodiscard]] bool finished() const { return schedule_.finished(); }
  [[nodiscard]] const OutputSchedule& schedule() const { return schedule_; }
  void archive(auto& archive) { archive(schedule_); }

  template <class Output>
  void start(const Output& output) {
    const typename Model::Moment moment = model_.moment();
    output(std::vector<Look>{{model_.state(), moment, schedule_.take(moment.time)}});
  }

  /// One interval of the model. Returns how many times of output lay in it.
  template <class Output>
  long advance(const Output& output) {
    const double target = scene_.output.exact ? schedule_.next() : scene_.time.end;
    const auto observations =
        model_.advance(target, [this](double reached) { return schedule_.times_until(reached); });
    std::vector<Look> looks;
    looks.reserve(observations.size());
    for (const auto& [state, flow] : observations) {
      looks.push_back({state, flow, schedule_.take(flow.time)});
    }
    if (!looks.empty()) output(looks);
    return static_cast<long>(looks.size());
  }

 private:
  const Scene& scene_;
  Model& model_;
  OutputSchedule schedule_;
};

}  // namespace suffuse

#include "driver/transport_cost.hpp"

#include <algorithm>
#include <cmath>

#include "files/number_text.hpp"

namespace suffuse {
namespace {

/// Time of a sweep over that of an explicit step, approximately (docs/evidence/accuracy.md).
constexpr double sweep_over_step = 3.0;

const PassTiming* pass(const std::vector<PassTiming>& passes, const std::string& name) {
  const auto found = std::ranges::find(passes, name, &PassTiming::name);
  return found != passes.end() && found->calls > 0 ? &*found : nullptr;
}

double seconds_per_call(const PassTiming& timing) {
  return timing.seconds / static_cast<double>(timing.calls);
}

}  // namespace

template <int Dim>
std::string transport_sentence(const TwoPhaseModel<Dim>& model, double end) {
  const std::vector<PassTiming> passes = model.passes();
  const double steps = std::ceil(model.explicit_transport_steps(end));
  const PassTiming* sweeps = pass(passes, "transport, implicit");
  const PassTiming* explicit_steps = pass(passes, "transport");
  if (sweeps != nullptr &&
      (explicit_steps == nullptr || sweeps->seconds > explicit_steps->seconds)) {
    const double each = seconds_per_call(*sweeps) / sweep_over_step;
    return "transport: implicit, " + std::to_string(sweeps->calls) +
           " steps up to t = " + short_text(model.time()) + " s; explicit would take " +
           short_text(steps) + " steps to the end, about " + duration_text(steps * each);
  }
  if (explicit_steps == nullptr) return "";
  const double each = seconds_per_call(*explicit_steps) * sweep_over_step;
  const double flows = static_cast<double>(model.steps()) * end / model.time();
  return "transport: explicit, " + short_text(steps) +
         " steps to the end at the flow of t = " + short_text(model.time()) +
         " s; implicit would take at least " + short_text(std::ceil(flows)) +
         " steps, one for each of the flow, about " + duration_text(flows * each) + " or more";
}

template <int Dim>
std::optional<std::string> many_crossings_warning(const TwoPhaseModel<Dim>& model, double end) {
  constexpr double many = 1e5;
  if (model.liquid_points() == 0 || model.steps() == 0) return std::nullopt;
  const double steps = model.explicit_transport_steps(end - model.time());
  if (!(steps > many)) return std::nullopt;
  double seconds = 0.0;
  for (const PassTiming& timing : model.passes()) seconds += timing.seconds;
  const double each = seconds / static_cast<double>(model.steps());
  return "liquid points have to cross " + short_text(steps) +
         " elements one after the other until t = " + short_text(end) + " s, about " +
         duration_text(steps * each) +
         " as steps go so far; formulation = \"single-point\" has transport without such a limit";
}

template std::string transport_sentence(const TwoPhaseModel<2>&, double);
template std::string transport_sentence(const TwoPhaseModel<3>&, double);
template std::optional<std::string> many_crossings_warning(const TwoPhaseModel<2>&, double);
template std::optional<std::string> many_crossings_warning(const TwoPhaseModel<3>&, double);

}  // namespace suffuse

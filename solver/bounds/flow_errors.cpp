#include "bounds/flow_errors.hpp"

namespace suffuse {

template <int Dim>
void FlowErrors<Dim>::record(const std::optional<MixedFlow<Dim>>& previous,
                             const MixedFlow<Dim>& start, const MixedStep<Dim>& end, double ahead,
                             double share) {
  if (share == 0.0) {
    of_step_ = {};
    return;
  }
  const auto errors = [&](const std::vector<double>* before, const std::vector<double>& from,
                          const std::vector<double>& to) {
    std::vector<double> result(to.size());
    for (std::size_t i = 0; i < to.size(); ++i) {
      const double slope = before ? ahead * (from[i] - (*before)[i]) : 0.0;
      result[i] = share * (to[i] - from[i] - slope);
    }
    return result;
  };
  of_step_.face_pressure = errors(previous ? &previous->state.face_pressure : nullptr,
                                  start.state.face_pressure, end.end.face_pressure);
  of_step_.face_flux =
      errors(previous ? &previous->flux_through : nullptr, start.flux_through, end.flux_through);
}

template <int Dim>
const DischargeBounds& FlowErrors<Dim>::find(SeepageState<Dim> state,
                                             const FlowCoefficients<Dim>& used) {
  const FlowCoefficients<Dim>& now = state.coefficients;
  state.step = of_step_;
  for (std::size_t e = 0; e < used.drag.size(); ++e) {
    const double ratio = now.porosity[e] / now.drag[e] * used.drag[e] / used.porosity[e];
    state.step.conductivity.push_back(ratio - 1.0);
  }
  std::vector<std::vector<double>> depends_on = {
      state.face_pressure,  state.face_flux,          now.porosity,           now.drag,
      state.step.face_flux, state.step.face_pressure, state.step.conductivity};
  if (!bounds_ || depends_on != found_for_) {
    bounds_ = discharge_bounds(state);
    found_for_ = std::move(depends_on);
  }
  return *bounds_;
}

template class FlowErrors<2>;
template class FlowErrors<3>;

}  // namespace suffuse

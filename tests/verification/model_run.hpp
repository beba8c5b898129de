#pragma once

/// Runs a model in memory to given times, without files.

#include <algorithm>
#include <cmath>
#include <vector>

#include "double_point.hpp"
#include "single_point.hpp"
#include "solver/double_point_case.hpp"

namespace suffuse::model {

/// A case, its plan and the model that runs it, kept together.
template <template <int> class Model>
class FormulationRun {
 public:
  explicit FormulationRun(Case<2> c, SolverOptions options = {})
      : case_(std::move(c)),
        options_(options),
        plan_(make_plan(case_, options_)),
        model_(case_, plan_, options_) {}

  /// State and flow at each of `times` (ascending).
  struct Moments {
    std::vector<typename Model<2>::State> states;
    std::vector<FlowMoment<2>> flows;
  };
  Moments run(const std::vector<double>& times) {
    Moments result;
    auto next = times.begin();
    while (next != times.end()) {
      const double remaining = times.back() - model_.state().time;
      const auto to_end = static_cast<long>(std::ceil(remaining / plan_.step * (1.0 - 1e-12)));
      const long steps = std::min(model_.steps_before_transport(plan_.step), std::max(1L, to_end));
      const double reached = model_.state().time + static_cast<double>(steps) * plan_.step;
      std::vector<double> within;
      for (; next != times.end() && *next <= reached * (1.0 + 1e-12); ++next) {
        within.push_back(*next);
      }
      for (auto& [state, flow] : model_.advance(steps, plan_.step, within)) {
        result.states.push_back(std::move(state));
        result.flows.push_back(std::move(flow));
      }
      steps_ += steps;
      note_residuals();
    }
    return result;
  }

  [[nodiscard]] Model<2>& model() { return model_; }
  [[nodiscard]] const Case<2>& input() const { return case_; }
  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] long steps() const { return steps_; }
  /// Largest residual of either constituent at the end of any interval.
  [[nodiscard]] double worst_residual() const { return worst_residual_; }

 private:
  void note_residuals() {
    const LedgerRow row = model_.ledger(model_.state());
    worst_residual_ =
        std::max({worst_residual_, std::abs(row.residual_water), std::abs(row.residual_grains)});
  }

  Case<2> case_;
  SolverOptions options_;
  Plan plan_;
  Model<2> model_;
  long steps_ = 0;
  double worst_residual_ = 0.0;
};

using ModelRun = FormulationRun<SinglePoint>;
using DoublePointRun = FormulationRun<DoublePoint>;

}  // namespace suffuse::model

#pragma once

/// Runs a model in memory to given times, without files.

#include <algorithm>
#include <cmath>
#include <vector>

#include "formulation/double_point.hpp"
#include "formulation/single_point.hpp"
#include "solver/double_point_case.hpp"

namespace suffuse::model {

/// A case, its plan and the model that runs it, kept together.
template <template <int> class Model>
class FormulationRun {
 public:
  explicit FormulationRun(Case<2> c, SolverOptions options = {})
      : case_(std::move(c)), plan_(make_plan(case_, options)), model_(case_, plan_) {}

  /// State and flow at each of `times` (ascending).
  struct Moments {
    std::vector<typename Model<2>::State> states;
    std::vector<FlowState<2>> flows;
  };
  Moments run(const std::vector<double>& times) {
    Moments result;
    auto next = times.begin();
    while (next != times.end()) {
      const auto within = [&](double reached) {
        std::vector<double> found;
        for (auto t = next; t != times.end() && *t <= reached; ++t) found.push_back(*t);
        return found;
      };
      for (auto& [state, flow] : model_.advance(times.back(), within)) {
        result.states.push_back(std::move(state));
        result.flows.push_back(std::move(flow));
        ++next;
      }
      note_residuals();
    }
    return result;
  }

  [[nodiscard]] Model<2>& model() { return model_; }
  [[nodiscard]] const Case<2>& input() const { return case_; }
  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] long steps() const { return model_.steps(); }
  /// Largest residual of either constituent at the end of any interval.
  [[nodiscard]] double worst_residual() const { return worst_residual_; }

 private:
  void note_residuals() {
    const LedgerRow row = model_.ledger(model_.state());
    worst_residual_ =
        std::max({worst_residual_, std::abs(row.residual_water), std::abs(row.residual_grains)});
  }

  Case<2> case_;
  Plan plan_;
  Model<2> model_;
  double worst_residual_ = 0.0;
};

using ModelRun = FormulationRun<SinglePoint>;
using DoublePointRun = FormulationRun<DoublePoint>;

}  // namespace suffuse::model

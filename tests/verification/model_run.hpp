#pragma once

/// Runs a model in memory to given times, without files.

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "driver/plan.hpp"
#include "formulation/double_point.hpp"
#include "formulation/single_point.hpp"
#include "solver/double_point_case.hpp"

namespace suffuse::model {

inline FinesState<2> liquid_of(const SinglePoint<2>& model) {
  return model.liquid();
}
inline LiquidPoints<2> liquid_of(const DoublePoint<2>& model) {
  return model.liquid().points();
}

/// State of a model at one time.
template <template <int> class Model>
struct ModelState {
  double time = 0.0;             ///< s
  std::vector<double> porosity;  ///< per solid point
  decltype(liquid_of(std::declval<const Model<2>&>())) liquid;
  HistoryRow history;
  LedgerRow ledger;
  std::vector<RegionRow> regions;
};

/// A case, its plan and the model that runs it, kept together.
template <template <int> class Model>
class FormulationRun {
 public:
  static constexpr Formulation formulation = std::is_same_v<Model<2>, DoublePoint<2>>
                                                 ? Formulation::double_point
                                                 : Formulation::single_point;

  explicit FormulationRun(Case<2> c, SolverOptions options = {})
      : case_(std::move(c)), plan_(make_plan(case_, options)), model_(case_, plan_) {}

  /// State and flow at each of `times` (ascending), and snapshots if requested.
  struct Moments {
    std::vector<ModelState<Model>> states;
    std::vector<FlowState<2>> flows;
    std::vector<Snapshot> snapshots;
  };
  Moments run(const std::vector<double>& times, bool with_snapshots = false) {
    Moments result;
    for (const double time : times) {
      while (model_.time() < time) {
        model_.advance(time);
        note_residuals();
      }
      result.flows.push_back(model_.flow_state());
      result.states.push_back(state());
      if (with_snapshots) result.snapshots.push_back(model_.snapshot(result.flows.back()));
    }
    return result;
  }

  [[nodiscard]] ModelState<Model> state() const {
    return {model_.time(),     model_.solid().porosity(),
            liquid_of(model_), model_.history_row(model_.flow_state()),
            model_.ledger(),   model_.region_rows()};
  }
  [[nodiscard]] Model<2>& model() { return model_; }
  [[nodiscard]] const Case<2>& input() const { return case_; }
  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] long steps() const { return model_.steps(); }
  /// Largest residual of either constituent at the end of any interval.
  [[nodiscard]] double worst_residual() const { return worst_residual_; }

 private:
  void note_residuals() {
    const LedgerRow row = model_.ledger();
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

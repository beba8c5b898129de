#pragma once

/// Runs scenes from their text to the ledger, in two and three dimensions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "driver/plan.hpp"
#include "formulation/two_phase_model.hpp"
#include "geometry.hpp"
#include "seeding.hpp"

namespace suffuse::model {

template <int Dim>
Case<Dim> case_of(const std::string& text, const std::vector<std::string>& overrides) {
  Case<Dim> c;
  c.document = parse_scene(text, "scene.toml", overrides);
  c.mesh = build_geometry_of<Dim>(c.document).mesh;
  complete_for_mesh(c.document, Dim);
  c.solid_points = seed_solid_points(c.mesh, c.document.scene);
  if (c.document.scene.formulation == Formulation::double_point) {
    c.liquid_points = seed_liquid_points(c.mesh, c.document.scene);
  }
  return c;
}

/// A scene's model, which runs to a sequence of times.
template <int Dim>
class SceneRun {
 public:
  SceneRun(const std::string& text, const std::vector<std::string>& overrides)
      : case_(case_of<Dim>(text, overrides)), model_(make_model(case_, make_plan(case_, {}))) {}

  void run_to(double t) {
    while (model_->time() < t) {
      model_->advance(t);
      const LedgerRow row = model_->ledger();
      worst_residual_ =
          std::max({worst_residual_, std::abs(row.residual_water), std::abs(row.residual_grains)});
    }
  }
  [[nodiscard]] const Case<Dim>& input() const { return case_; }
  [[nodiscard]] LedgerRow ledger() const { return model_->ledger(); }
  [[nodiscard]] HistoryRow history() const { return model_->history_row(model_->flow_state()); }
  [[nodiscard]] Snapshot snapshot() const { return model_->snapshot(model_->flow_state()); }
  [[nodiscard]] std::vector<ProbeRow> probes() const {
    return model_->probe_rows(model_->flow_state());
  }
  [[nodiscard]] std::vector<double> probed() const {
    std::vector<double> pressures;
    for (const ProbeRow& row : probes()) {
      pressures.push_back(row.pressure);
    }
    return pressures;
  }
  [[nodiscard]] double worst_residual() const { return worst_residual_; }

 private:
  Case<Dim> case_;
  std::unique_ptr<TwoPhaseModel<Dim>> model_;
  double worst_residual_ = 0.0;
};

}  // namespace suffuse::model

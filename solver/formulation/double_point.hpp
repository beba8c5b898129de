#pragma once

/// The double-point formulation: solid points erode, and liquid points carry water and fluidised
/// fines through the pores. A strategy, `PointTransport`, moves the liquid points.

#include "formulation/two_phase_model.hpp"
#include "points/point_transport.hpp"

namespace suffuse {

template <int Dim>
class DoublePoint final : public TwoPhaseModel<Dim> {
 public:
  /// Keeps references to the case and what it holds.
  DoublePoint(const Case<Dim>& c, const ModelOptions& options);

  void start_from(const EarlierState<Dim>& earlier) override;
  [[nodiscard]] EarlierState<Dim> last_state() const override;
  void advance(double latest) override;

  [[nodiscard]] const PointTransport<Dim>& liquid() const { return *liquid_; }
  [[nodiscard]] long liquid_points() const override { return liquid_->size(); }
  [[nodiscard]] HistoryRow history_row(const FlowState<Dim>& flow) const override;
  [[nodiscard]] Snapshot snapshot(const FlowState<Dim>& flow) const override;
  void archive(StateArchive& archive) override;
  [[nodiscard]] std::vector<PassTiming> passes() const override;

 private:
  [[nodiscard]] const Transport<Dim>& transport() const override { return *liquid_; }
  [[nodiscard]] PoreState pores() const override;
  void find_liquid(PointFlows& flows) const override;
  /// The fines are a linear fit to those of the points.
  [[nodiscard]] FinesState<Dim> fines_state(const FlowState<Dim>& flow) const override;
  [[nodiscard]] std::vector<Stored> stored() const override;
  /// Updates the flow with `pores`.
  void update_flow(const PoreState& pores);
  /// Pores full of clean water.
  [[nodiscard]] PoreState clean_pores() const;
  /// Creates flow and liquid points as the scene specifies.
  void start_liquid();
  /// Linear fit to the concentrations of the points, per element and field node.
  [[nodiscard]] ElementField<Dim> fitted(const FlowState<Dim>& flow) const;
  /// Concentrations of liquid points with these volumes.
  [[nodiscard]] std::vector<double> concentrations(const LiquidPoints<Dim>& points,
                                                   const std::vector<double>& volume) const;

  LiquidDensities densities_;
  std::unique_ptr<PointTransport<Dim>> liquid_;
  PassTiming coefficients_timing_{"coefficients of the flow", 0, 0.0};
};

}  // namespace suffuse

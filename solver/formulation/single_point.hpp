#pragma once

/// The single-point formulation: every material point represents soil and liquid. Fluidised fines
/// are a field on the mesh, and the mass of water of each element is a state variable.

#include "field/field_transport.hpp"
#include "formulation/two_phase_model.hpp"

namespace suffuse {

template <int Dim>
class SinglePoint final : public TwoPhaseModel<Dim> {
 public:
  /// Keeps references to the case and what it holds.
  SinglePoint(const Case<Dim>& c, const ModelOptions& options);

  void start_from(const EarlierState<Dim>& earlier) override;
  [[nodiscard]] EarlierState<Dim> last_state() const override;
  void advance(double latest) override;

  [[nodiscard]] const FinesState<Dim>& liquid() const { return fines_->state(); }
  /// Mass of water per element, kg.
  [[nodiscard]] const std::vector<double>& water_mass() const { return water_mass_; }
  [[nodiscard]] HistoryRow history_row(const FlowState<Dim>& flow) const override;
  [[nodiscard]] Snapshot snapshot(const FlowState<Dim>& flow) const override;
  void archive(StateArchive& archive) override;
  [[nodiscard]] std::vector<PassTiming> passes() const override;

 private:
  [[nodiscard]] const Transport<Dim>& transport() const override { return *fines_; }
  [[nodiscard]] PoreState pores() const override;
  /// Pores with this air, m3 per element (empty if all soil is saturated).
  [[nodiscard]] PoreState pores_with(std::vector<double> air_volume) const;
  /// Concentration of the liquid that crosses each face.
  [[nodiscard]] std::vector<double> face_concentration() const {
    return fines_->face_concentration(this->time_, this->flux_history_.mean);
  }
  void find_liquid(PointFlows& flows) const override;
  [[nodiscard]] FinesState<Dim> fines_state(const FlowState<Dim>& /*flow*/) const override {
    return fines_->state();
  }
  [[nodiscard]] std::vector<Stored> stored() const override;
  /// Books liquid and fines, m3, that crossed faces in an interval of the flow.
  void book(const FaceVolumes& volumes, std::vector<double> fines);
  /// Updates the flow with the present pores.
  void update_flow();
  /// Sets the water masses from the pressures.
  void follow_pressure();
  /// Makes water masses and pressures agree.
  void match_masses();

  std::unique_ptr<FieldTransport<Dim>> fines_;
  std::vector<double> water_mass_;  ///< per element, kg
  PassTiming water_timing_{"water masses and coefficients", 0, 0.0};
};

}  // namespace suffuse

#pragma once

/// Liquid points that carry the flow (material-point integration, as in the paper): in each step
/// nodes take their velocity and elements their pressure from the points; points take back the
/// change of both (FLIP) and move.

#include "explicit/carried_points.hpp"
#include "explicit/explicit_flow.hpp"
#include "points/point_transport.hpp"

namespace suffuse {

template <int Dim>
class PointsCarryingFlow final : public PointTransport<Dim>, private FlowCarrier<Dim> {
 public:
  /// Makes clean points at these places with the pressure and velocity of `flow`, which has
  /// started, outlives this object, and is carried by these points from now on.
  PointsCarryingFlow(const Grid<Dim>& grid, const Skeleton<Dim>& solid, ExplicitFlow<Dim>& flow,
                     InjectionSettings injection, LiquidDensities densities, double bulk_modulus,
                     int threads, const MaterialPoints<Dim>& places);

  /// Pores grow only a little in an interval, as an injected point takes up its part of all that
  /// the interval eroded.
  [[nodiscard]] typename Transport<Dim>::Coupling coupling() const override {
    return {.steps = 1.0, .pore_growth = 2e-4};
  }
  [[nodiscard]] double longest_step(const std::vector<double>& face_rate) const override;

  [[nodiscard]] const LiquidPoints<Dim>& points() const override {
    if (output_points_.size() == 0) output_points_ = points_.blocks().points();
    return output_points_;
  }
  [[nodiscard]] long size() const override { return points_.blocks().size(); }
  [[nodiscard]] LiquidContent content() const override;
  [[nodiscard]] std::vector<double> point_pressure(const LiquidPoints<Dim>& points,
                                                   const FlowState<Dim>& flow) const override;
  [[nodiscard]] std::vector<double> point_volume(
      const LiquidPoints<Dim>& points, const std::vector<double>& pressure) const override;
  void describe(const FlowState<Dim>& flow, HistoryRow& row) const override;

  void archive(StateArchive& archive) override;
  [[nodiscard]] std::vector<PassTiming> passes() const override {
    return {exchange_timing_, this->fines_timing_, this->movement_timing_};
  }

 private:
  void before_steps(const std::vector<double>& porosity) override;
  void before_step() override;
  void after_step(double dt) override;

  void start_interval(const FlowProgress& /*flow*/) override {}
  [[nodiscard]] double steps_needed(double /*start*/, const FlowProgress& /*flow*/) const override {
    return 1.0;
  }
  /// Gives the fines to the points, which have moved already.
  void advance(const TransportStep& step, const FaceVolumes& volumes,
               const std::vector<double>& eroded, const std::vector<double>& pressure) override;
  /// Takes points. If they have no pressure and velocity, their elements and nodes give these.
  void take_points(LiquidPoints<Dim> points, const FlowState<Dim>& flow) override;
  void fill(LiquidPoints<Dim> points, const std::vector<double>& pressure,
            const VectorField<Dim>& velocity);
  [[nodiscard]] bool has_points(int element) const override {
    return points_.blocks().count(element) > 0;
  }
  void inject(double dt);

  ExplicitFlow<Dim>& flow_;
  CarriedPoints<Dim> points_;
  /// Points sorted for outputs; made on demand, empty once the points change.
  mutable LiquidPoints<Dim> output_points_;
  std::vector<double> porosity_;  ///< per element, in the middle of the interval
  PassTiming exchange_timing_{"exchange of points and nodes", 0, 0.0};

  // Values of one step; members, so that steps do not allocate.
  std::vector<double> pressure_before_;  ///< per element, at the start of the step, Pa
  VectorField<Dim> node_flux_;           ///< m/s
  std::vector<double> entered_;          ///< per open face, m3
  std::vector<InjectedPoint<Dim>> injected_;
  std::vector<ArrivingPoint<Dim>> arriving_;
  std::vector<PointCrossing> moved_;
};

}  // namespace suffuse

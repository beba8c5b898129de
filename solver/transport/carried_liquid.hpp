#pragma once

/// Liquid points between the steps of a flow that they carry: they give it velocity and pressure,
/// take back the change, move, come in and leave. Erosion is not its business.

#include <functional>

#include "flow/explicit_flow.hpp"
#include "transport/carried_points.hpp"
#include "transport/lagrangian.hpp"

namespace suffuse {

template <int Dim>
class CarriedLiquid final : public FlowCarrier {
 public:
  /// `entering` is kept up to date; `moved` hears after each step who changed region in it.
  CarriedLiquid(const Grid<Dim>& grid, ExplicitFlow<Dim>& flow,
                const LagrangianTransport<Dim>& transport, LiquidDensities densities, int threads,
                InflowAccount& entering);

  [[nodiscard]] PointBlocks<Dim>& blocks() { return points_.blocks(); }
  [[nodiscard]] const PointBlocks<Dim>& blocks() const { return points_.blocks(); }
  [[nodiscard]] const CarriedPoints<Dim>& carried() const { return points_; }
  /// Per element, what divides the flux of the steps to come.
  void set_porosity(std::vector<double> porosity) { porosity_ = std::move(porosity); }
  /// Who is told that steps begin, with their duration, and who changed region in a step.
  std::function<void(double duration)> on_start;
  std::function<void(const std::vector<CarriedCrossing>& crossings)> on_moved;

  /// The points at a time within the step just made, before `take`, with their fines of now or as
  /// noted; `entering` goes on to that time. Returns who changed region since the step began.
  std::vector<PointCrossing> look(double time, bool fines_as_noted, LiquidPoints<Dim>& points,
                                  InflowAccount& entering) const;

  void start(double duration) override { on_start(duration); }
  void give(double time, double dt) override;
  void take() override;

  /// Between intervals of the flow.
  void archive(auto& archive) { archive(blocks(), exchange_, movement_); }

  /// Exchange with nodes and elements, and movement.
  [[nodiscard]] const PassTiming& exchange() const { return exchange_; }
  [[nodiscard]] const PassTiming& movement() const { return movement_; }

 private:
  /// Flux of the step just made, and what it brought through the open faces.
  void find_motion(LiquidMotion<Dim>& motion) const;
  void let_in();

  const Grid<Dim>& grid_;
  ExplicitFlow<Dim>& flow_;
  const LagrangianTransport<Dim>& transport_;
  LiquidDensities densities_;
  CarriedPoints<Dim> points_;
  InflowAccount& entering_;
  std::vector<double> porosity_;
  double step_begin_ = 0.0;
  double dt_ = 0.0;

  std::vector<double> pressure_before_;  ///< per element, that the step began with, Pa
  LiquidMotion<Dim> motion_;
  std::vector<InjectedPoint<Dim>> born_;
  std::vector<ArrivingPoint<Dim>> arriving_;
  std::vector<CarriedCrossing> crossings_;
  PassTiming exchange_{"exchange of points and nodes", 0, 0.0};
  PassTiming movement_{"movement of liquid points", 0, 0.0};
};

}  // namespace suffuse

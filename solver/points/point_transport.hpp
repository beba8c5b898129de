#pragma once

/// Liquid as material points (double-point formulation): what both strategies of moving them share.

#include <optional>

#include "field/solid_exchange.hpp"
#include "field/transport.hpp"
#include "files/tables.hpp"
#include "points/fines_deposition.hpp"
#include "points/fines_transfer.hpp"
#include "points/point_crossing.hpp"
#include "points/point_injection.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

/// Masses that crossed borders of regions in an interval.
struct RegionCrossings {
  std::vector<PointCrossing> points;
  /// Per region: fines that its solid gave minus those that its liquid received, kg. At a border of
  /// regions fines of one may join liquid of the other.
  std::vector<double> fines_out;
};

/// The liquid that another run left.
template <int Dim>
struct EarlierLiquid {
  LiquidPoints<Dim> points;
  InflowAccount inflow;
  std::vector<double> pending;  ///< per node, m3
};

/// Volume of fines and of all liquid at p = 0, per element, m3.
struct LiquidContent {
  std::vector<double> fines;
  std::vector<double> liquid;
};

template <int Dim>
class PointTransport : public Transport<Dim> {
 public:
  PointTransport(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                 const std::vector<FaceCondition>& conditions, InjectionSettings injection,
                 LiquidDensities densities, double bulk_modulus, int threads);

  [[nodiscard]] typename Transport<Dim>::Coupling coupling() const override {
    return {.steps = 4.0, .pore_growth = 1e-3};
  }

  /// Moves liquid and fines through an interval that the flow has crossed since `start`, s, in
  /// steps, each after the exchange of fines with the solid. `pressure`: per element, Pa. `steps`:
  /// their number; nothing for as many as points need. Returns what crossed borders; the reference
  /// holds until the next interval. Throws NumericalError, also where far too many steps are
  /// needed.
  const RegionCrossings& move(double start, const FlowProgress& flow,
                              const std::vector<double>& pressure, SolidExchange<Dim>& exchange,
                              std::optional<double> steps = {});

  /// Sorted by element. The reference holds until the next interval.
  [[nodiscard]] virtual const LiquidPoints<Dim>& points() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  [[nodiscard]] virtual LiquidContent content() const = 0;
  /// Mean concentration of the points in each element; 0 where there is none.
  [[nodiscard]] std::vector<double> element_concentration() const;
  /// Mean concentration of each element at the middle of the step to come, as it went in the last
  /// one (of second order), below `most`.
  [[nodiscard]] std::vector<double> concentration_ahead(double most) const;
  /// Whether fines wait at nodes for liquid.
  [[nodiscard]] bool has_pending() const;

  /// Pressure at each point, Pa.
  [[nodiscard]] virtual std::vector<double> point_pressure(const LiquidPoints<Dim>& points,
                                                           const FlowState<Dim>& flow) const = 0;
  /// Liquid volume of each point, m3; `pressure` per element, Pa.
  [[nodiscard]] virtual std::vector<double> point_volume(
      const LiquidPoints<Dim>& points, const std::vector<double>& pressure) const = 0;
  /// Columns of the history that this strategy alone knows.
  virtual void describe(const FlowState<Dim>& /*flow*/, HistoryRow& /*row*/) const {}

  /// Volume of fines per node that waits for liquid, m3.
  [[nodiscard]] const std::vector<double>& pending() const { return pending_; }
  [[nodiscard]] const InflowAccount& inflow() const { return inflow_; }
  /// Elements of soil without a liquid point: now, and added up over all movements of points.
  [[nodiscard]] int empty_elements() const;
  [[nodiscard]] double empty_elements_total() const { return empty_total_; }

  /// Starts with the liquid of another run, whose last flow was `flow`.
  void start_from(const EarlierLiquid<Dim>& earlier, const FlowState<Dim>& flow) {
    inflow_ = earlier.inflow;
    pending_ = earlier.pending;
    take_points(earlier.points, flow);
  }
  /// This liquid for another run.
  [[nodiscard]] EarlierLiquid<Dim> last_liquid() const { return {points(), inflow_, pending_}; }

  void archive(StateArchive& archive) override {
    archive(inflow_, pending_, empty_total_, concentration_before_, fines_timing_,
            movement_timing_);
  }

 protected:
  virtual void start_interval(const FlowProgress& flow) = 0;
  /// Number of steps that points need for an interval.
  [[nodiscard]] virtual double steps_needed(double start, const FlowProgress& flow) const = 0;
  /// One step. `eroded`: fines that each solid point gives to the liquid in it, m3; empty where
  /// none can.
  virtual void advance(const TransportStep& step, const FaceVolumes& volumes,
                       const std::vector<double>& eroded, const std::vector<double>& pressure) = 0;
  /// The soil has taken the deposits of a step: the next one starts with the pores that they leave.
  virtual void follow_deposits() {}
  /// Elements whose solid does not erode as they have no liquid, 1 for each; empty where none is.
  [[nodiscard]] std::vector<char> dry_elements() const;
  /// Replaces all points by these, which need not carry the flow.
  virtual void take_points(LiquidPoints<Dim> points, const FlowState<Dim>& flow) = 0;
  [[nodiscard]] virtual bool has_points(int element) const = 0;
  void start_crossings();
  void book(const typename FinesTransfer<Dim>::Result& transferred);
  /// Books what the last step left: the solid's gain against the liquid's loss, by region.
  void book_deposition();

  const Grid<Dim>& grid_;
  const Skeleton<Dim>& solid_;
  LiquidDensities densities_;
  double bulk_modulus_;
  int threads_;
  PointInjection<Dim> injection_;
  FinesTransfer<Dim> transfer_;
  FinesDeposition<Dim> deposition_;
  InflowAccount inflow_;
  std::vector<double> pending_;
  double empty_total_ = 0.0;
  RegionCrossings crossings_;
  /// Concentration of the elements a step ago, where the exchange of fines depends on it; otherwise
  /// empty.
  std::vector<double> concentration_before_;
  PassTiming fines_timing_{"transfer of fines", 0, 0.0};
  PassTiming movement_timing_{"movement of liquid points", 0, 0.0};
};

/// Steps of transport over an interval in which points may cross the share `allowed` of it at a
/// time. Throws NumericalError where these would be far too many.
double checked_step_count(double allowed, double start, double duration);

}  // namespace suffuse

#pragma once

/// Liquid as material points (double-point formulation): what both strategies of moving them share.

#include "results/tables.hpp"
#include "solid/skeleton.hpp"
#include "transport/fines_deposition.hpp"
#include "transport/fines_transfer.hpp"
#include "transport/point_injection.hpp"
#include "transport/transport.hpp"

namespace suffuse {

/// A point that changed its region; -1 is outside.
struct PointCrossing {
  int from;
  int to;
  int entered_by;     ///< outer face, -1: none
  int left_by;        ///< likewise
  double water_mass;  ///< kg
  double fines_mass;  ///< kg
};

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

  /// Sorted by element. The reference holds until the next interval.
  [[nodiscard]] virtual const LiquidPoints<Dim>& points() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  [[nodiscard]] virtual LiquidContent content() const = 0;
  /// Elements whose solid waits for liquid before it erodes, 1 for each; empty where none does.
  [[nodiscard]] std::vector<char> waiting() const;
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

  /// Fines that the last step left in the soil, per solid point, m3; empty: none.
  [[nodiscard]] const std::vector<double>& deposited() const { return deposition_.deposited(); }
  /// The soil has them: the next step starts with the pores that they leave.
  virtual void follow_deposits() {}

  /// Of this interval.
  [[nodiscard]] const RegionCrossings& crossings() const { return crossings_; }
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
    archive(inflow_, pending_, empty_total_, fines_timing_, movement_timing_);
  }

 protected:
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
  PassTiming fines_timing_{"transfer of fines", 0, 0.0};
  PassTiming movement_timing_{"movement of liquid points", 0, 0.0};
};

/// Steps of transport over an interval in which points may cross the share `allowed` of it at a
/// time. Throws NumericalError where these would be far too many.
double checked_step_count(double allowed, double start, double duration);

}  // namespace suffuse

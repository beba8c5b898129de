#pragma once

/// Liquid as material points (double-point formulation): common base of both strategies.

#include <optional>

#include "field/solid_exchange.hpp"
#include "field/transport.hpp"
#include "files/tables.hpp"
#include "points/fines_deposition.hpp"
#include "points/fines_transfer.hpp"
#include "points/point_crossing.hpp"
#include "points/point_injection.hpp"
#include "points/shared_points.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

/// Masses that crossed borders of regions in an interval.
struct RegionCrossings {
  std::vector<PointCrossing> points;
  /// Per region: fines that its solid gave minus those that its liquid received, kg, on all ranks.
  /// Fines of one region may join liquid of another one at their border.
  std::vector<double> fines_out;
};

/// The last liquid of another run.
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

  /// Moves liquid and fines through the interval of the flow from `start`, s, in steps, each after
  /// the exchange of fines with the solid. `pressure`: per element, Pa. `steps`: their number;
  /// nothing: as many as points need. Returns what crossed borders; the reference is valid until
  /// the next interval. Throws NumericalError, also if far too many steps are needed.
  const RegionCrossings& move(double start, const FlowProgress& flow,
                              const std::vector<double>& pressure, SolidExchange<Dim>& exchange,
                              std::optional<double> steps = {});

  /// Points of this rank, sorted by element. The reference is valid until the next interval.
  [[nodiscard]] virtual const LiquidPoints<Dim>& points() const = 0;
  /// Likewise, with copies of the points in elements of other ranks that are here. All ranks have
  /// to call it.
  [[nodiscard]] LiquidPoints<Dim> points_around() const { return shared_.with_copies(points()); }
  /// Number of points of all ranks.
  [[nodiscard]] virtual long size() const = 0;
  [[nodiscard]] virtual LiquidContent content() const = 0;
  /// Mean concentration of the points in each element; 0 without points.
  [[nodiscard]] std::vector<double> element_concentration() const;
  /// Mean concentration of each element at the middle of the next step, extrapolated from the last
  /// step (second order), below `most`.
  [[nodiscard]] std::vector<double> concentration_ahead(double most) const;
  /// Whether fines are pending at nodes.
  [[nodiscard]] bool has_pending() const;

  /// Pressure at each point, Pa.
  [[nodiscard]] virtual std::vector<double> point_pressure(const LiquidPoints<Dim>& points,
                                                           const FlowState<Dim>& flow) const = 0;
  /// Liquid volume of each point, m3; `pressure` per element, Pa.
  [[nodiscard]] virtual std::vector<double> point_volume(
      const LiquidPoints<Dim>& points, const std::vector<double>& pressure) const = 0;
  /// Sets the columns of the history that only this strategy has.
  virtual void describe(const FlowState<Dim>& /*flow*/, HistoryRow& /*row*/) const {}

  /// Volume of fines pending at each node until liquid comes near, m3.
  [[nodiscard]] const std::vector<double>& pending() const { return pending_; }
  [[nodiscard]] const InflowAccount& inflow() const { return inflow_; }
  /// Number of soil elements without a liquid point: now, and summed over all movements of points.
  [[nodiscard]] double empty_elements() const;
  [[nodiscard]] double empty_elements_total() const { return empty_total_; }

  /// Starts from the liquid of another run, whose last flow was `flow`.
  void start_from(const EarlierLiquid<Dim>& earlier, const FlowState<Dim>& flow) {
    inflow_ = earlier.inflow;
    pending_ = earlier.pending;
    take_points(earlier.points, flow);
  }
  /// The present liquid, for another run.
  [[nodiscard]] EarlierLiquid<Dim> last_liquid() const { return {points(), inflow_, pending_}; }

  void archive(StateArchive& archive) override {
    archive(inflow_, on_nodes(pending_), empty_total_, on_elements(concentration_before_),
            fines_timing_, movement_timing_);
  }

 protected:
  virtual void start_interval(const FlowProgress& flow) = 0;
  /// Number of steps that points need for an interval.
  [[nodiscard]] virtual double steps_needed(double start, const FlowProgress& flow) const = 0;
  /// Moves the liquid by one step. `eroded`: fines from each solid point in it, m3; empty if there
  /// is no exchange.
  virtual void advance(const TransportStep& step, const FaceVolumes& volumes,
                       const std::vector<double>& eroded, const std::vector<double>& pressure) = 0;
  /// Takes over the porosity after the soil has received the deposits of a step.
  virtual void follow_deposits() {}
  /// 1 for each element that does not erode because it has no liquid; empty if there is none.
  [[nodiscard]] std::vector<char> dry_elements() const;
  /// Replaces all points by these, which need not carry the flow.
  virtual void take_points(LiquidPoints<Dim> points, const FlowState<Dim>& flow) = 0;
  [[nodiscard]] virtual bool has_points(int element) const = 0;
  void start_crossings();
  void book(const typename FinesTransfer<Dim>::Result& transferred);
  /// Books the deposits of the last step by region: gain of the solid and loss of the liquid.
  void book_deposition();

  const Grid<Dim>& grid_;
  const Skeleton<Dim>& solid_;
  LiquidDensities densities_;
  double bulk_modulus_;
  int threads_;
  SharedPoints<Dim> shared_;
  PointInjection<Dim> injection_;
  FinesTransfer<Dim> transfer_;
  FinesDeposition<Dim> deposition_;
  InflowAccount inflow_;
  std::vector<double> pending_;
  double empty_total_ = 0.0;
  RegionCrossings crossings_;
  // Fines of the interval per region, kg, of this rank: what solid and liquid gave, and what they
  // received.
  std::vector<ExactSum> given_;
  std::vector<ExactSum> received_;
  /// Concentration of the elements one step before, if the exchange of fines depends on it;
  /// otherwise empty.
  std::vector<double> concentration_before_;
  PassTiming fines_timing_{"transfer of fines", 0, 0.0};
  PassTiming movement_timing_{"movement of liquid points", 0, 0.0};
};

}  // namespace suffuse

#pragma once

/// Liquid points that carry the flow (material-point integration) in one step of the flow. Nodes
/// and elements take velocity and pressure from the points; the points take back the change of both
/// (FLIP) and move. A point that stays in its element moves by one formula; only points that leave
/// it are walked from face to face.

#include <exception>
#include <vector>

#include "grid/point_walk.hpp"
#include "mixed/flow.hpp"
#include "points/point_blocks.hpp"
#include "points/point_crossing.hpp"

namespace suffuse {

/// Change of the flow in a step, at nodes and elements.
template <int Dim>
struct FlowChange {
  const VectorField<Dim>& velocity_before;     ///< m/s
  const VectorField<Dim>& velocity;            ///< m/s
  const std::vector<double>& pressure_before;  ///< Pa
  const std::vector<double>& pressure;         ///< Pa
};

/// An entering point, and its remaining time in the step, s.
template <int Dim>
struct ArrivingPoint {
  PointPlace<Dim> place;
  CarriedPoint<Dim> point;
  double time;
  int face;  ///< outer face by which it enters
};

template <int Dim>
class CarriedPoints {
 public:
  CarriedPoints(const Grid<Dim>& grid, LiquidDensities densities, int threads);

  [[nodiscard]] PointBlocks<Dim>& blocks() { return blocks_; }
  [[nodiscard]] const PointBlocks<Dim>& blocks() const { return blocks_; }
  /// Number of points that entered another element in the last step.
  [[nodiscard]] long travelled() const;

  /// Nodes take the points' mean velocity, weighted with mass, elements the mean pressure, weighted
  /// with volume at p = 0. Without points near, a value does not change.
  void points_to_grid(VectorField<Dim>& velocity, std::vector<double>& pressure);

  /// Applies the change to the points and moves them with the flux of the step for `duration`
  /// seconds, as `walk` would. Arriving points take no change and move for their own time. Appends
  /// points that changed region to `crossings`, in an order that does not depend on the threads.
  /// Throws NumericalError as `walk` does.
  void grid_to_points(const FlowChange<Dim>& change, const WalkField<Dim>& field, double duration,
                      const std::vector<ArrivingPoint<Dim>>& arriving,
                      std::vector<PointCrossing>& crossings);

 private:
  /// Sums over the points of an element for one of its nodes.
  struct Corner {
    double mass;
    Vector<Dim> momentum;
  };
  /// A point that moves to another element.
  struct Traveller {
    int to;
    CarriedPoint<Dim> point;
  };
  /// Points that leave the elements that one thread handles together.
  struct Departures {
    std::vector<Traveller> travellers;
    std::vector<PointCrossing> crossings;
    std::exception_ptr failure;
  };
  /// The step of the points in one element.
  struct ElementStep {
    std::array<Vector<Dim>, Dim + 1> gain;  ///< of velocity, at the nodes, m/s
    double pressure_gain;                   ///< Pa
    /// Coordinate a moves by the sum of drift[a][b] times coordinate b.
    std::array<std::array<double, Dim + 1>, Dim> drift;
  };
  [[nodiscard]] ElementStep element_step(int element, const FlowChange<Dim>& change,
                                         const WalkField<Dim>& field, double duration) const;
  void points_to_corners(int element, double& pressure);
  void move_points(int element, const ElementStep& step, const WalkField<Dim>& field,
                   double duration, Departures& departures);
  /// Where a point was before the step.
  struct Origin {
    int region;      ///< -1: outside
    int entered_by;  ///< outer face, -1 for none
  };
  void send(PointPlace<Dim> place, CarriedPoint<Dim> point, Origin origin,
            const WalkField<Dim>& field, double time, Departures& departures) const;
  void put_into_elements();

  const Grid<Dim>& grid_;
  LiquidDensities densities_;
  int threads_;
  PointBlocks<Dim> blocks_;
  std::vector<Corner> corners_;   ///< Dim + 1 per element
  std::vector<int> node_corner_;  ///< rows as grid.node_element
  std::vector<Departures> departures_;
};

}  // namespace suffuse

#pragma once

/// Hands what solid points lose to liquid points, to the last gram.

#include "solid/rigid_skeleton.hpp"
#include "transport/liquid_points.hpp"

namespace suffuse {

/// Both ways share by liquid volume. `element` (the paper's): among the points of the element that
/// eroded. `nodal`: eroded volume goes to the element's nodes by their shape functions, and from
/// each node, by its shape function again, to the points of eroding elements around it, or to all
/// points around it where none lies in an eroding element. What erodes in an element without points
/// takes the nodal way in either case. A node that sees no point keeps its share pending.
template <int Dim>
class GrainTransfer {
 public:
  GrainTransfer(const Grid<Dim>& grid, const RigidSkeleton<Dim>& skeleton, double grain_density);

  struct Result {
    std::vector<double> received;  ///< per region: grains its liquid took up, kg
    std::vector<double> eroded;    ///< per region: grains its solid lost, kg
  };

  /// Solid points went from porosity `before` to `after`; `begins` are the points of each element,
  /// `point_volume` their liquid volumes, m3. `pending` is the volume of grains per node that waits
  /// for liquid, m3; its content is handed out first.
  Result transfer(const std::vector<double>& before, const std::vector<double>& after,
                  const std::vector<double>& porosity, const std::vector<int>& begins,
                  const std::vector<double>& point_volume, LiquidPoints<Dim>& points,
                  std::vector<double>& pending) const;

 private:
  const Grid<Dim>& grid_;
  const RigidSkeleton<Dim>& skeleton_;
  double grain_density_;
};

}  // namespace suffuse

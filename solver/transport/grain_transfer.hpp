#pragma once

/// Hands what solid points lose to liquid points, to the last gram.

#include "solid/rigid_skeleton.hpp"
#include "transport/liquid_points.hpp"

namespace suffuse {

/// `element` (the paper's): what an element eroded is shared among its points by volume.
///
/// `nodal`: each point of an eroding element would by itself take phi_e V_p / n_L, exact along its
/// path (Eq. 5). The sum of that misses the eroded volume by as much as points fill the pores
/// unevenly; the two are compared at the nodes, smoothed over a few elements, and each point takes
/// its own times their ratio. A common factor near one closes the balance. What erodes in an
/// element without points takes this way in either case. Where no eroding element near a node has a
/// point, grains go to any point that the node sees; where it sees none they stay pending.
template <int Dim>
class GrainTransfer {
 public:
  GrainTransfer(const Grid<Dim>& grid, const RigidSkeleton<Dim>& skeleton, double grain_density);

  struct Result {
    std::vector<double> received;  ///< per region: grains its liquid took up, kg
    std::vector<double> eroded;    ///< per region: grains its solid lost, kg
  };

  /// Solid points went from porosity `before` to `after`; `porosity` is that of the elements
  /// before; `begins` are the points of each element, `point_volume` their liquid volumes, m3.
  /// `pending` is the volume of grains per node that waits for liquid, m3; its content is handed
  /// out first.
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

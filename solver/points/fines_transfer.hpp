#pragma once

/// Gives the fines that solid points lose to liquid points, so that none are lost or made.

#include <functional>

#include "points/fines_uptake.hpp"
#include "points/liquid_points.hpp"
#include "points/point_blocks.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// `element` (the paper's): what an element eroded is shared among its points by volume.
///
/// `nodal`: each point of an eroding element would by itself take up phi_e V_p / n_L, exact along
/// its path (Eq. 5). The sum of that misses the eroded volume by as much as points fill the pores
/// unevenly; the two are compared at the nodes, smoothed over a few elements, and each point gets
/// its own uptake times their ratio. A common factor near one closes the balance. What erodes in an
/// element without points goes through the nodes in either case. Where no eroding element near a
/// node has a point, fines go to any point around the node; where there is none they stay pending.
template <int Dim>
class FinesTransfer {
 public:
  FinesTransfer(const Grid<Dim>& grid, const SoilMap<Dim>& soils, double grain_density);

  struct Result {
    std::vector<double> received;  ///< per region: fines its liquid took up, kg
    std::vector<double> eroded;    ///< per region: fines its solid lost, kg
  };

  /// `exchange`: what each solid point gave, m3, empty for nothing; `porosity`: of the elements
  /// before. `pending` is the volume of fines per node that waits for liquid, m3; its content is
  /// handed out first. The points' volumes are those at p = 0: uptakes are compared near by, where
  /// all are packed alike.
  Result transfer(const std::vector<double>& exchange, const std::vector<double>& porosity,
                  LiquidDensities densities, PointBlocks<Dim>& points,
                  std::vector<double>& pending) const;

  /// Hands fines to points that moved while porosity grew: instead of phi_e V_p / n_L each point by
  /// itself takes up `own_volume` of each of its `uptakes`, and the comparison gives each uptake
  /// its mass. By `element`, what an element eroded is shared in proportion to the uptakes there.
  /// `points`, in any order, are where they ended; `point_volume`: their liquid volumes, m3.
  Result transfer_along_paths(const std::vector<double>& exchange,
                              const std::vector<double>& point_volume, LiquidPoints<Dim>& points,
                              std::vector<FinesUptake<Dim>>& uptakes,
                              std::vector<double>& pending) const;

 private:
  /// Volume that eroded, m3: per element, and per node what goes by the nodes, with what waited.
  struct Eroded {
    std::vector<double> in_element;
    std::vector<double> at_node;
  };
  [[nodiscard]] Eroded collect(const std::vector<double>& exchange,
                               const std::function<bool(int)>& stays_in_element,
                               std::vector<double>& pending, Result& result) const;
  /// What points get: `factor` of a node times what they would take up by themselves, and
  /// `per_volume` times their own volume (empty when nothing is left to hand out so).
  struct Handout {
    std::vector<double> factor;
    std::vector<double> per_volume;
  };
  /// `uptake`: what points near each node would take up by themselves, m3; compared after `rounds`
  /// of smoothing. `liquid_around` adds to each node the volume of liquid around it, m3.
  [[nodiscard]] Handout compare(
      const std::vector<double>& at_node, const std::vector<double>& uptake, int rounds,
      const std::function<void(std::vector<double>& volume)>& liquid_around,
      std::vector<double>& pending) const;
  [[nodiscard]] bool shares_by_element(int e) const {
    return soils_.soil_of_element(e).erosion.mass_transfer == MassTransfer::element;
  }
  [[nodiscard]] double at_place(int e, const std::array<double, Dim + 1>& barycentric,
                                const std::vector<double>& at_nodes) const {
    double value = 0.0;
    for (int a = 0; a <= Dim; ++a) value += barycentric[a] * at_nodes[grid_.mesh.elements[e][a]];
    return value;
  }

  const Grid<Dim>& grid_;
  const SoilMap<Dim>& soils_;
  double grain_density_;
};

}  // namespace suffuse

#pragma once

/// Transfers the fines that solid points lose to liquid points; conserves their mass.

#include <functional>

#include "points/fines_uptake.hpp"
#include "points/liquid_points.hpp"
#include "points/point_blocks.hpp"
#include "points/shared_points.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// `element` (the paper's): the fines of an element are distributed to its points by volume.
///
/// `nodal`: the own uptake of a point in an eroding element is phi_e V_p / n_L, exact along its
/// path (Eq. 5). The sum of own uptakes differs from the eroded volume, because points fill the
/// pores unevenly. Both are compared at the nodes, smoothed over a few elements, and each point
/// gets its own uptake times their ratio. A common factor near one closes the balance. Fines of an
/// element without points go through the nodes in either case. If no eroding element near a node
/// has a point, they go to any point around the node; without any they stay pending.
template <int Dim>
class FinesTransfer {
 public:
  /// Keeps references. All ranks have to call all functions.
  FinesTransfer(const Grid<Dim>& grid, const SoilMap<Dim>& soils, const SharedPoints<Dim>& shared,
                double grain_density);

  /// Sums of this rank.
  struct Result {
    std::vector<ExactSum> received;  ///< per region: fines its liquid took up, kg
    std::vector<ExactSum> eroded;    ///< per region: fines its solid lost, kg
  };

  /// `exchange`: fines from each solid point, m3, empty: none; `porosity`: of the elements before
  /// the exchange. `pending`: volume of fines kept per node, m3; it is transferred too. The points'
  /// volumes are those at p = 0, because only ratios of near volumes matter.
  Result transfer(const std::vector<double>& exchange, const std::vector<double>& porosity,
                  LiquidDensities densities, PointBlocks<Dim>& points,
                  std::vector<double>& pending) const;

  /// Transfers fines to points that moved while porosity grew: their own uptakes are `own_volume`
  /// of `uptakes`, and the comparison sets the mass of each. With `element`, the fines of an
  /// element are distributed in proportion to the uptakes there. `points`, in any order, are at
  /// their final places; `point_volume`: their liquid volumes, m3.
  Result transfer_along_paths(const std::vector<double>& exchange,
                              const std::vector<double>& point_volume, LiquidPoints<Dim>& points,
                              std::vector<FinesUptake<Dim>>& uptakes,
                              std::vector<double>& pending) const;

 private:
  /// Eroded volume, m3: per element, and per node the part that goes through nodes, with pending.
  struct Eroded {
    std::vector<double> in_element;
    std::vector<double> at_node;
  };
  [[nodiscard]] Eroded collect(const std::vector<double>& exchange,
                               const std::function<bool(int)>& stays_in_element,
                               std::vector<double>& pending, Result& result) const;
  /// Fines for points: `factor` of a node times their own uptake, plus `per_volume` times their
  /// volume (empty if no fines are left for it, on any rank).
  struct Handout {
    std::vector<double> factor;
    std::vector<double> per_volume;
  };
  /// Compares the fines at nodes with `uptake`, the own uptakes of points near each node, m3, after
  /// `rounds` of smoothing. `liquid_around` finds the volume of liquid around each node, m3.
  [[nodiscard]] Handout compare(const std::vector<double>& at_node,
                                const std::vector<double>& uptake, int rounds,
                                const std::function<std::vector<double>()>& liquid_around,
                                std::vector<double>& pending) const;
  /// Distributes node values to the elements in equal parts, and back to the nodes; keeps their
  /// sum.
  [[nodiscard]] std::vector<double> smoothed(std::vector<double> at_nodes, int rounds) const;
  /// Sums at nodes of what points bring to the corners of elements; `give` as in `SharedPoints`.
  template <class Give>
  [[nodiscard]] std::vector<double> sums_at_nodes(const Give& give) const;
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
  const SharedPoints<Dim>& shared_;
  double grain_density_;
  std::vector<int> elements_at_node_;  ///< of the whole mesh
};

}  // namespace suffuse

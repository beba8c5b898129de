#pragma once

/// The flux that erosion laws with a length see: a mean over the soil around a place.

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "grid/grid.hpp"
#include "linear/lagged_preconditioner.hpp"
#include "solid/point_flows.hpp"

namespace suffuse {

/// q~ = N / M, where
///
///     N - div(l^2 grad N) = w |q|,    M - div(l^2 grad M) = w
///
/// in all soil that erodes with a length l, without flux of N or M through its borders; w is the
/// share of the fines that is left. So q~ is a weighted mean of |q| over the fines around a place,
/// and a channel without fines does not count (docs/theory/exchange.md, "Channels with a width"). N
/// and M are linear in elements, with lumped masses.
template <int Dim>
class NonlocalFlux {
 public:
  /// Keeps references to the grid and the soils, whose points must not move.
  NonlocalFlux(const Grid<Dim>& grid, const SoilMap<Dim>& soils, int threads);
  NonlocalFlux(const NonlocalFlux&) = delete;
  NonlocalFlux& operator=(const NonlocalFlux&) = delete;

  /// Sets `eroding_flux` of the flows, and `eroding_flux_change` if they have a `flux_change`.
  /// \param fines_left  w per solid point
  void find(const std::vector<double>& fines_left, PointFlows& flows);

 private:
  void number_nodes();
  void assemble();
  /// Finds M, unless it is that of the last call.
  void find_weight(const std::vector<double>& fines_left);
  /// Sum of the values at points over the nodes, in shares of the points' barycentric coordinates.
  [[nodiscard]] Eigen::VectorXd at_nodes(const std::vector<double>& values) const;
  [[nodiscard]] Eigen::VectorXd smoothed(const Eigen::VectorXd& source);
  /// Value at each point of soil with a length; other points keep theirs of `values`.
  [[nodiscard]] std::vector<double> at_points(const Eigen::VectorXd& nodes,
                                              std::vector<double> values) const;
  [[nodiscard]] double length(int element) const {
    return soils_.erosion_of_element(element).length;
  }

  const Grid<Dim>& grid_;
  const SoilMap<Dim>& soils_;
  std::vector<int> unknown_;  ///< per node; -1: none
  int count_ = 0;             ///< number of unknowns
  Eigen::SparseMatrix<double> matrix_;
  Eigen::VectorXd volume_;          ///< of the points around each node, m3
  std::vector<double> fines_left_;  ///< of which the two below are
  std::vector<double> weight_;      ///< w per solid point
  Eigen::VectorXd mean_weight_;     ///< M per node
  LaggedPreconditioner solver_;
};

}  // namespace suffuse

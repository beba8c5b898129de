#pragma once

/// The flux that erosion laws with a length see: a mean over the soil around a place.

#include <Eigen/SparseCore>
#include <optional>
#include <vector>

#include "grid/grid.hpp"
#include "linear/lagged_preconditioner.hpp"
#include "linear/shared_system.hpp"
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
  /// Keeps references to the grid and the soils, whose points must not move. All ranks have to call
  /// all functions.
  NonlocalFlux(const Grid<Dim>& grid, const SoilMap<Dim>& soils, int threads);
  NonlocalFlux(const NonlocalFlux&) = delete;
  NonlocalFlux& operator=(const NonlocalFlux&) = delete;

  /// Sets `eroding_flux` of the flows. It is a mean over their interval, without a `flux_change`.
  /// \param fines_left  w per solid point
  void find(const std::vector<double>& fines_left, PointFlows& flows);

 private:
  using Values = Eigen::VectorXd;

  void number_nodes();
  void assemble();
  /// Finds M, unless it is that of the last call.
  void find_weight(const std::vector<double>& fines_left);
  /// The solution S per unknown of S - div(l^2 grad S) = `source`, which is given at the points.
  [[nodiscard]] Values smoothed(const Values& source);
  [[nodiscard]] double length(int element) const {
    return soils_.erosion_of_element(element).length;
  }

  const Grid<Dim>& grid_;
  const SoilMap<Dim>& soils_;
  std::vector<int> unknown_;  ///< per node; -1: none
  int count_ = 0;             ///< number of unknowns
  Eigen::SparseMatrix<double> matrix_;
  /// Per unknown and solid point: its shape function there; none for soil without a length.
  Eigen::SparseMatrix<double> shape_;
  std::vector<double> fines_left_;  ///< those of the two below
  Values weight_;                   ///< w per solid point
  Values mean_weight_;              ///< M per unknown
  LaggedPreconditioner solver_;
  std::optional<SharedSystem> shared_;  ///< on several ranks, in the place of `solver_`
};

}  // namespace suffuse

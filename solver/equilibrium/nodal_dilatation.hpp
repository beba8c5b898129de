#pragma once

/// Mean dilatation of elements around nodes, against locking.

#include <array>
#include <vector>

#include "grid/grid.hpp"

namespace suffuse {

/// Soil that keeps its volume, or changes it as its plastic flow demands, is too stiff on triangles
/// and tetrahedra with linear displacements: there are more elements, each with a condition on its
/// volume, than displacements. So laws see the mean of the volume ratio over the nodes of an
/// element, where a node has the mean of the elements around it,
///
///     Jm = A J,   A = N W^-1 N^T diag(w) / (d + 1),   W = N^T w,
///
/// with N_ea = 1 if the node a is one of the element e, and the volume w_e of its soil (Bonet and
/// Burton, Commun. Numer. Meth. Eng. 14 (1998) 437; Detournay and Dzik, "Nodal mixed discretization
/// for tetrahedral elements", FLAC symposium (2006)). A keeps the volume of all elements together.
/// Elements of different regions do not share a mean. Triangles of a crossed mesh do not lock, and
/// keep their own.
template <int Dim>
class NodalDilatation {
 public:
  NodalDilatation() = default;
  /// \param weight  per element: the volume of its soil, m3; 0: it takes no part
  NodalDilatation(const Grid<Dim>& grid, std::vector<double> weight);

  /// Whether any element shares its dilatation.
  [[nodiscard]] bool acts() const { return !weight_.empty(); }
  [[nodiscard]] bool is_shared(int element) const { return acts() && weight_[element] > 0.0; }
  /// A `values`, per element; elements that share nothing keep theirs.
  [[nodiscard]] std::vector<double> mean(const std::vector<double>& values) const;
  /// A^T `values`, per element; 0 where nothing is shared.
  [[nodiscard]] std::vector<double> spread(const std::vector<double>& values) const;

 private:
  /// N W^-1 N^T / (d + 1) of the values, times a factor per element.
  [[nodiscard]] std::vector<double> over_nodes(const std::vector<double>& values) const;

  std::vector<double> weight_;                    ///< per element, m3; 0: not shared
  std::vector<std::array<int, Dim + 1>> corner_;  ///< per element: its nodes in its region
  std::vector<double> around_;                    ///< W per node in a region, m3
};

}  // namespace suffuse

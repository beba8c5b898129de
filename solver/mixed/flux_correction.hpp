#pragma once

/// Makes fluxes through faces balance in every element to the last digits.

#include <vector>

#include "boundary/face_conditions.hpp"
#include "boundary/leaky_walls.hpp"
#include "grid/grid.hpp"

namespace suffuse {

/// Fluxes computed from pressures balance up to the round-off of the pressures times conductances:
/// with a contrast of 1e8 between soils that is 1e-8 of the flux through the tighter one. What is
/// missing is sent along a spanning tree of the elements, over the faces that conduct best (where
/// that round-off comes from), to the outside. One sweep from the leaves to the root; the same
/// order always. Prescribed fluxes are not in the tree and do not change.
template <int Dim>
class FluxCorrection {
 public:
  /// The outside is reached through the faces with a prescribed pressure. `walls`: the faces of the
  /// grid that have partners.
  FluxCorrection(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions,
                 std::vector<LeakyFace> walls = {});

  /// Lays the tree along the best conductances. `conductance`: per element, mobility over volume,
  /// 1/(m Pa s), or in any unit where there are no walls. A tree stays while no two elements have
  /// changed relative to each other by more than `stale_change`: any tree is right, a good one
  /// changes fluxes less.
  void follow(const std::vector<double>& conductance);
  static constexpr double stale_change = 10.0;

  /// Changes `face_flux` (along each face's normal) so that the net outflow of each element becomes
  /// `net_outflow`. In a piece that no pressure face opens to the outside the sum of what is
  /// missing stays in the piece's first element. Call `follow` before.
  void correct(std::vector<double>& face_flux, const std::vector<double>& net_outflow) const;

  /// The tree has a history.
  void archive(auto& archive) { archive(followed_, from_root_, drain_); }

  /// Number of connected pieces of the mesh without a pressure face.
  [[nodiscard]] int sealed_piece_count() const { return static_cast<int>(sealed_root_.size()); }
  /// Per element: which of them it is in; -1 where a pressure face can be reached.
  [[nodiscard]] const std::vector<int>& sealed_piece() const { return sealed_piece_; }
  /// Their first elements.
  [[nodiscard]] const std::vector<int>& sealed_root() const { return sealed_root_; }

 private:
  const Grid<Dim>& grid_;
  std::vector<LeakyFace> walls_;
  std::vector<int> passable_;  ///< interior and pressure faces, and one side of each wall
  std::vector<int> sealed_piece_;
  std::vector<int> sealed_root_;
  std::vector<double> followed_;  ///< conductances the tree was laid for
  std::vector<int> from_root_;    ///< elements, each after the one it drains to
  std::vector<int> drain_;        ///< per element: face towards the root, -1 at a root
};

}  // namespace suffuse

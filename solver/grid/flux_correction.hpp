#pragma once

/// Makes fluxes through faces balance in every element to the last digits.

#include <vector>

#include "grid/grid.hpp"
#include "ranks/disjoint_sets.hpp"
#include "ranks/shared_graph.hpp"

namespace suffuse {

/// Fluxes computed from pressures balance up to the round-off of pressures times conductances: with
/// a contrast of 1e8 between soils that is 1e-8 of the flux through the tighter one. The missing
/// part is sent to the outside along a spanning tree of the elements, over the faces that conduct
/// best (where that round-off comes from), in one sweep from the leaves to the root, always in one
/// order. Prescribed fluxes are not in the tree and do not change.
///
/// On several ranks the tree is that of the whole mesh. Where a rank joins two sets of its elements
/// that both reach another rank or the outside, another way may be better: all such edges and all
/// faces between ranks make a small graph, of which each rank finds the tree. What flows between
/// the parts of the tree on each rank is found first; then each sweeps its own.
template <int Dim>
class FluxCorrection {
 public:
  /// The outside is reached through the faces that are `held`, per face: those with a prescribed
  /// pressure. `walls`: the faces of the grid that have partners. All ranks have to call all
  /// functions.
  FluxCorrection(const Grid<Dim>& grid, std::vector<char> held, std::vector<LeakyFace> walls = {});

  /// Builds the tree along the best conductances. `conductance`: per element, mobility over volume,
  /// 1/(m Pa s), or in any unit if there are no walls. The tree is kept while no two elements have
  /// changed relative to each other by more than `stale_change`: any tree is correct, a good one
  /// changes fluxes less.
  void follow(const std::vector<double>& conductance);
  static constexpr double stale_change = 10.0;

  /// Changes `face_flux` (along each face's normal) so that the net outflow of each element becomes
  /// `net_outflow`. In a piece without a pressure face the sum of the missing flux stays in the
  /// piece's first element. Call `follow` before.
  void correct(std::vector<double>& face_flux, const std::vector<double>& net_outflow) const;

  /// The conductances for which the tree was built, per element: what it depends on.
  [[nodiscard]] const std::vector<double>& followed() const { return followed_; }
  /// Builds the tree for these again; empty: there is none.
  void restore(std::vector<double> followed) {
    followed_ = std::move(followed);
    if (!followed_.empty()) build_tree();
  }

  /// Number of connected pieces of the mesh without a pressure face.
  [[nodiscard]] int sealed_piece_count() const { return static_cast<int>(sealed_root_.size()); }
  /// Per element: its piece; -1 if it is connected with a pressure face.
  [[nodiscard]] const std::vector<int>& sealed_piece() const { return sealed_piece_; }
  /// First element of each piece; -1 on ranks that do not own it.
  [[nodiscard]] const std::vector<int>& sealed_root() const { return sealed_root_; }

 private:
  static constexpr int none = -1;
  static constexpr long outside = -1;  ///< its number among the elements of the whole mesh

  void find_pieces();
  void build_tree();
  /// Marks the faces of the tree, per face.
  [[nodiscard]] std::vector<char> choose_faces() const;
  /// Finds the parts of the tree on this rank and how they drain.
  void join_parts(const std::vector<char>& in_tree);
  [[nodiscard]] std::vector<double> face_conductances() const;
  /// Element beyond a passable face, with the outside as one more element, the last.
  [[nodiscard]] int beyond(int face) const {
    return grid_.is_border(face) ? grid_.mesh.element_count() : grid_.beyond(face);
  }
  /// What flows between the parts of the tree on the ranks; changes fluxes and own excesses.
  void correct_between_ranks(std::vector<double>& face_flux, std::vector<double>& excess) const;

  /// A face of the tree between ranks.
  struct Passage {
    int face;
    int element;     ///< own one
    long part;       ///< that drains through it
    bool is_inflow;  ///< that part is of the other rank
  };

  const Grid<Dim>& grid_;
  std::vector<char> held_;
  std::vector<LeakyFace> walls_;
  std::vector<int> inner_;     ///< passable faces between own elements or to the outside, ascending
  std::vector<int> crossing_;  ///< passable faces to elements of other ranks, ascending
  std::vector<int> sealed_piece_;
  std::vector<int> sealed_root_;
  std::vector<double> followed_;  ///< conductances for which the tree was built
  std::vector<int> from_root_;    ///< own elements, each after the one it drains to
  std::vector<int> drain_;        ///< per element: face towards the root, -1 at a root
  std::vector<long> part_;        ///< per element: lowest element of its part of the tree
  std::vector<Passage> passages_;
  SharedForest parts_;
};

}  // namespace suffuse

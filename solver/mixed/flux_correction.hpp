#pragma once

/// Makes fluxes through faces balance in every element to the last digits.

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "boundary/face_conditions.hpp"
#include "boundary/leaky_walls.hpp"
#include "grid/grid.hpp"

namespace suffuse {

/// Sets of nodes that can be joined (union-find).
class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Joins the sets of two nodes. Returns false if they are one set already.
  bool join(int a, int b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    parent_[std::max(a, b)] = std::min(a, b);
    return true;
  }

 private:
  std::vector<int> parent_;
};

/// Fluxes computed from pressures balance up to the round-off of pressures times conductances: with
/// a contrast of 1e8 between soils that is 1e-8 of the flux through the tighter one. The missing
/// part is sent to the outside along a spanning tree of the elements, over the faces that conduct
/// best (where that round-off comes from), in one sweep from the leaves to the root, always in one
/// order. Prescribed fluxes are not in the tree and do not change.
template <int Dim>
class FluxCorrection {
 public:
  /// The outside is reached through the faces with a prescribed pressure. `walls`: the faces of the
  /// grid that have partners.
  FluxCorrection(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions,
                 std::vector<LeakyFace> walls = {})
      : grid_(grid), walls_(std::move(walls)) {
    // The outside counts as one more element, the last.
    const int elements = grid.mesh.element_count();
    DisjointSets pieces(elements + 1);
    for (int f = 0; f < grid.face_count(); ++f) {
      if (grid.is_border(f) && conditions[f].kind != FaceKind::pressure) continue;
      const int partner = grid.face_partner[f];
      if (partner >= 0 && partner < f) continue;
      passable_.push_back(f);
      pieces.join(grid.face_left[f], grid.is_border(f) ? elements : grid.beyond(f));
    }
    std::vector<int> piece_of_set(elements + 1, -1);
    sealed_piece_.assign(elements, -1);
    for (int e = 0; e < elements; ++e) {
      const int set = pieces.find(e);
      if (set == pieces.find(elements)) continue;
      if (piece_of_set[set] < 0) {
        piece_of_set[set] = sealed_piece_count();
        sealed_root_.push_back(e);
      }
      sealed_piece_[e] = piece_of_set[set];
    }
  }

  /// Builds the tree along the best conductances. `conductance`: per element, mobility over volume,
  /// 1/(m Pa s), or in any unit if there are no walls. The tree is kept while no two elements have
  /// changed relative to each other by more than `stale_change`: any tree is correct, a good one
  /// changes fluxes less.
  void follow(const std::vector<double>& conductance) {
    const int elements = grid_.mesh.element_count();
    if (!followed_.empty()) {
      double least = std::numeric_limits<double>::infinity();
      double most = 0.0;
      for (int e = 0; e < elements; ++e) {
        const double change = conductance[e] / followed_[e];
        least = std::min(least, change);
        most = std::max(most, change);
      }
      if (most <= stale_change * least) return;
    }
    followed_ = conductance;

    // Kruskal, Proc. Amer. Math. Soc. 7 (1956) 48, from the best conducting face down.
    std::vector<double> face_conductance(grid_.face_count());
    for (const int f : passable_) {
      double value = conductance[grid_.face_left[f]];
      if (!grid_.is_border(f)) value = std::min(value, conductance[grid_.beyond(f)]);
      face_conductance[f] = value * grid_.face_normal[f].squaredNorm();
    }
    for (const LeakyFace& wall : walls_) {
      face_conductance[wall.face] = std::min(face_conductance[wall.face], wall.conductance);
    }
    std::vector<int> by_conductance = passable_;
    std::stable_sort(by_conductance.begin(), by_conductance.end(),
                     [&](int a, int b) { return face_conductance[a] > face_conductance[b]; });
    DisjointSets joined(elements + 1);
    std::vector<char> in_tree(grid_.face_count(), 0);
    for (const int f : by_conductance) {
      if (!joined.join(grid_.face_left[f], grid_.is_border(f) ? elements : grid_.beyond(f)))
        continue;
      in_tree[f] = 1;
      if (grid_.face_partner[f] >= 0) in_tree[grid_.face_partner[f]] = 1;
    }

    drain_.assign(elements, -1);
    from_root_.clear();
    from_root_.reserve(elements);
    for (const int f : passable_) {
      if (in_tree[f] != 0 && grid_.is_border(f)) {
        drain_[grid_.face_left[f]] = f;
        from_root_.push_back(grid_.face_left[f]);
      }
    }
    from_root_.insert(from_root_.end(), sealed_root_.begin(), sealed_root_.end());
    for (std::size_t i = 0; i < from_root_.size(); ++i) {
      const int e = from_root_[i];
      for (const int f : grid_.element_face[e]) {
        if (in_tree[f] == 0 || f == drain_[e] || grid_.is_border(f)) continue;
        const int next = grid_.face_left[f] == e ? grid_.beyond(f) : grid_.face_left[f];
        const int partner = grid_.face_partner[f];
        drain_[next] = partner < 0 ? f : partner;
        from_root_.push_back(next);
      }
    }
  }
  static constexpr double stale_change = 10.0;

  /// Changes `face_flux` (along each face's normal) so that the net outflow of each element becomes
  /// `net_outflow`. In a piece without a pressure face the sum of the missing flux stays in the
  /// piece's first element. Call `follow` before.
  void correct(std::vector<double>& face_flux, const std::vector<double>& net_outflow) const {
    const int elements = grid_.mesh.element_count();
    std::vector<double> excess(elements);
    for (int e = 0; e < elements; ++e) {
      double outflow = 0.0;
      for (int k = 0; k <= Dim; ++k) {
        outflow += grid_.element_face_sign[e][k] * face_flux[grid_.element_face[e][k]];
      }
      excess[e] = outflow - net_outflow[e];
    }
    for (std::size_t i = from_root_.size(); i-- > 0;) {
      const int e = from_root_[i];
      const int f = drain_[e];
      if (f < 0) continue;
      const bool is_left = grid_.face_left[f] == e;
      face_flux[f] -= is_left ? excess[e] : -excess[e];
      if (grid_.face_partner[f] >= 0) face_flux[grid_.face_partner[f]] = -face_flux[f];
      const int receiver = is_left ? grid_.beyond(f) : grid_.face_left[f];
      if (receiver >= 0) excess[receiver] += excess[e];
    }
  }

  /// The tree depends on earlier conductances, so it is stored.
  void archive(auto& archive) { archive(followed_, from_root_, drain_); }

  /// Number of connected pieces of the mesh without a pressure face.
  [[nodiscard]] int sealed_piece_count() const { return static_cast<int>(sealed_root_.size()); }
  /// Per element: its piece; -1 if it is connected with a pressure face.
  [[nodiscard]] const std::vector<int>& sealed_piece() const { return sealed_piece_; }
  /// First element of each piece.
  [[nodiscard]] const std::vector<int>& sealed_root() const { return sealed_root_; }

 private:
  const Grid<Dim>& grid_;
  std::vector<LeakyFace> walls_;
  std::vector<int> passable_;  ///< interior and pressure faces, and one side of each wall
  std::vector<int> sealed_piece_;
  std::vector<int> sealed_root_;
  std::vector<double> followed_;  ///< conductances for which the tree was built
  std::vector<int> from_root_;    ///< elements, each after the one it drains to
  std::vector<int> drain_;        ///< per element: face towards the root, -1 at a root
};

}  // namespace suffuse

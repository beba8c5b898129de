#include "equilibrium/dilatation_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace suffuse {
namespace {

/// Faces whose areas differ by less than this share count as equal.
constexpr double equal_areas = 1e-4;
constexpr int tetrahedra_of_patch = 4;

/// Per element: whether it is a quarter of a quadrangle: four triangles around a node inside.
std::vector<char> quarters(const Grid<2>& grid) {
  const Mesh<2>& mesh = grid.mesh;
  std::vector<int> around(mesh.node_count(), 0);
  for (const auto& nodes : mesh.elements) {
    for (const int i : nodes) ++around[i];
  }
  for (int f = 0; f < grid.face_count(); ++f) {
    if (!grid.is_outer(f)) continue;
    for (const int i : grid.face_nodes[f]) around[i] = 0;
  }
  std::vector<char> result(mesh.elements.size(), 0);
  for (std::size_t e = 0; e < result.size(); ++e) {
    const auto is_middle = [&](int i) { return around[i] == 4; };
    result[e] = std::ranges::any_of(mesh.elements[e], is_middle) ? 1 : 0;
  }
  return result;
}

std::vector<char> quarters(const Grid<3>& grid) {
  std::vector<char> none(grid.mesh.elements.size(), 0);
  return none;
}

/// Joins the elements of a mesh to patches.
template <int Dim>
class Joining {
 public:
  explicit Joining(const Grid<Dim>& grid)
      : grid_(grid), crossed_(quarters(grid)), patch_(crossed_.size(), -1) {}

  std::vector<int> find() {
    if (Dim == 2) {
      join_pairs();
    } else {
      for (int e = 0; e < grid_.mesh.element_count(); ++e) {
        if (is_free(e)) grow_from(e);
      }
    }
    while (join_what_is_left()) continue;
    return std::move(patch_);
  }

 private:
  [[nodiscard]] bool is_free(int e) const { return crossed_[e] == 0 && patch_[e] < 0; }

  /// Element beyond a side of `e` that may be in the same patch, or -1.
  [[nodiscard]] int beyond(int e, int side) const {
    const int f = grid_.element_face[e][side];
    if (grid_.is_outer(f)) return -1;
    const int other = grid_.face_left[f] == e ? grid_.face_right[f] : grid_.face_left[f];
    const std::vector<int>& region = grid_.mesh.element_region;
    return crossed_[other] == 0 && region[other] == region[e] ? other : -1;
  }

  void put(int e, int patch) {
    patch_[e] = patch;
    size_.resize(std::max<std::size_t>(size_.size(), patch + 1), 0);
    ++size_[patch];
  }

  void join_pairs() {
    std::vector<int> faces;
    for (int f = 0; f < grid_.face_count(); ++f) {
      if (!grid_.is_outer(f)) faces.push_back(f);
    }
    std::ranges::stable_sort(faces,
                             [&](int a, int b) { return length_class(a) > length_class(b); });
    for (const int f : faces) {
      const int left = grid_.face_left[f];
      const int right = grid_.face_right[f];
      if (!is_free(left) || !is_free(right)) continue;
      if (beyond(left, grid_.side_of(left, f)) != right) continue;
      const auto patch = static_cast<int>(size_.size());
      put(left, patch);
      put(right, patch);
    }
  }
  /// Logarithm of a face's area in steps of `equal_areas`: round-off does not decide.
  [[nodiscard]] long length_class(int f) const {
    return std::lround(std::log(grid_.face_normal[f].norm()) / equal_areas);
  }

  void grow_from(int seed) {
    std::vector<int> elements{seed};
    std::vector<int> nodes(grid_.mesh.elements[seed].begin(), grid_.mesh.elements[seed].end());
    while (static_cast<int>(elements.size()) < tetrahedra_of_patch) {
      const int next = nearest_of(elements, nodes);
      if (next < 0) break;
      elements.push_back(next);
      for (const int i : grid_.mesh.elements[next]) {
        if (std::ranges::find(nodes, i) == nodes.end()) nodes.push_back(i);
      }
    }
    if (2 * static_cast<int>(elements.size()) <= tetrahedra_of_patch) return;
    const auto patch = static_cast<int>(size_.size());
    for (const int e : elements) put(e, patch);
  }
  /// Free element beside a growing patch that has most nodes in common with it, or -1.
  [[nodiscard]] int nearest_of(const std::vector<int>& elements,
                               const std::vector<int>& nodes) const {
    int best = -1;
    long most = 0;
    for (const int e : elements) {
      for (int side = 0; side <= Dim; ++side) {
        const int other = beyond(e, side);
        if (other < 0 || !is_free(other) || std::ranges::find(elements, other) != elements.end()) {
          continue;
        }
        const long common = std::ranges::count_if(grid_.mesh.elements[other], [&](int i) {
          return std::ranges::find(nodes, i) != nodes.end();
        });
        if (common <= most) continue;
        best = other;
        most = common;
      }
    }
    return best;
  }

  /// Returns whether an element has joined.
  bool join_what_is_left() {
    bool joined = false;
    for (int e = 0; e < grid_.mesh.element_count(); ++e) {
      if (!is_free(e)) continue;
      int best = -1;
      for (int side = 0; side <= Dim; ++side) {
        const int other = beyond(e, side);
        if (other < 0 || patch_[other] < 0) continue;
        if (best < 0 || size_[patch_[other]] < size_[best]) best = patch_[other];
      }
      if (best < 0) continue;
      put(e, best);
      joined = true;
    }
    return joined;
  }

  const Grid<Dim>& grid_;
  std::vector<char> crossed_;
  std::vector<int> patch_;
  std::vector<int> size_;  ///< per patch
};

}  // namespace

template <int Dim>
std::vector<int> dilatation_patches(const Grid<Dim>& grid) {
  return Joining<Dim>(grid).find();
}

template std::vector<int> dilatation_patches(const Grid<2>&);
template std::vector<int> dilatation_patches(const Grid<3>&);

}  // namespace suffuse

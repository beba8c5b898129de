#include "grid/dilatation_patches.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace suffuse {
namespace {

/// Sides count as equally long if they differ by less than this share.
constexpr double equal_lengths = 1e-4;
constexpr int tetrahedra_of_patch = 4;

/// Per element: whether it is one of four triangles around an inner node.
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
      : grid_(grid), is_quarter_(quarters(grid)), patch_(is_quarter_.size(), -1) {}

  std::vector<int> make_patches() {
    if (Dim == 2) {
      join_pairs();
    } else {
      for (int e = 0; e < grid_.mesh.element_count(); ++e) {
        if (is_free(e)) grow_from(e);
      }
    }
    while (join_what_is_left()) continue;
    // Regions of one or two elements have no patch yet.
    for (int e = 0; e < grid_.mesh.element_count(); ++e) {
      if (!is_free(e)) continue;
      add_to_patch(e, static_cast<int>(size_.size()));
      while (join_what_is_left()) continue;
    }
    return std::move(patch_);
  }

 private:
  [[nodiscard]] bool is_free(int e) const { return is_quarter_[e] == 0 && patch_[e] < 0; }

  /// Element beyond a side of `e` that may be in the same patch, or -1.
  [[nodiscard]] int neighbour(int e, int side) const {
    const int f = grid_.element_face[e][side];
    if (grid_.is_outer(f)) return -1;
    const int other = grid_.face_left[f] == e ? grid_.face_right[f] : grid_.face_left[f];
    const std::vector<int>& region = grid_.mesh.element_region;
    return is_quarter_[other] == 0 && region[other] == region[e] ? other : -1;
  }

  void add_to_patch(int e, int patch) {
    patch_[e] = patch;
    size_.resize(std::max<std::size_t>(size_.size(), patch + 1), 0);
    ++size_[patch];
  }

  void join_pairs() {
    for (const int f : inner_faces_by_length()) {
      const int left = grid_.face_left[f];
      const int right = grid_.face_right[f];
      if (!is_free(left) || !is_free(right)) continue;
      if (neighbour(left, grid_.side_of(left, f)) != right) continue;
      const auto patch = static_cast<int>(size_.size());
      add_to_patch(left, patch);
      add_to_patch(right, patch);
    }
  }
  /// Faces between elements that may share a patch, longest first; those of equal length in the
  /// order of their numbers, so that round-off does not decide.
  [[nodiscard]] std::vector<int> inner_faces_by_length() const {
    std::vector<std::pair<double, int>> faces;  // with their lengths
    for (int f = 0; f < grid_.face_count(); ++f) {
      if (grid_.is_outer(f) || is_quarter_[grid_.face_left[f]] != 0) continue;
      faces.emplace_back(grid_.face_normal[f].norm(), f);
    }
    std::ranges::sort(faces, std::greater());
    std::vector<int> result;
    result.reserve(faces.size());
    for (std::size_t k = 0; k < faces.size();) {
      const double longest = faces[k].first;
      const std::size_t from = result.size();
      while (k < faces.size() && faces[k].first > (1.0 - equal_lengths) * longest) {
        result.push_back(faces[k++].second);
      }
      std::ranges::sort(result.begin() + static_cast<std::ptrdiff_t>(from), result.end());
    }
    return result;
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
    for (const int e : elements) add_to_patch(e, patch);
  }
  /// Free element next to a growing patch that shares most nodes with it, or -1.
  [[nodiscard]] int nearest_of(const std::vector<int>& elements,
                               const std::vector<int>& nodes) const {
    int best = -1;
    long most = 0;
    for (const int e : elements) {
      for (int side = 0; side <= Dim; ++side) {
        const int other = neighbour(e, side);
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
        const int other = neighbour(e, side);
        if (other < 0 || patch_[other] < 0) continue;
        if (best < 0 || size_[patch_[other]] < size_[best]) best = patch_[other];
      }
      if (best < 0) continue;
      add_to_patch(e, best);
      joined = true;
    }
    return joined;
  }

  const Grid<Dim>& grid_;
  std::vector<char> is_quarter_;
  std::vector<int> patch_;
  std::vector<int> size_;  ///< per patch
};

}  // namespace

template <int Dim>
std::vector<int> dilatation_patches(const Grid<Dim>& grid) {
  return Joining<Dim>(grid).make_patches();
}

template std::vector<int> dilatation_patches(const Grid<2>&);
template std::vector<int> dilatation_patches(const Grid<3>&);

}  // namespace suffuse

#include "hilbert_order.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mesh/faces.hpp"
#include "mesh/slit.hpp"

namespace suffuse {

namespace {

/// Position of each element's centroid on the curve.
template <int Dim>
std::vector<std::uint64_t> element_positions(const Mesh<Dim>& mesh) {
  constexpr int level = finest_hilbert_level<Dim>;
  constexpr auto last_cell = static_cast<double>((std::uint64_t{1} << level) - 1);
  Vector<Dim> low = mesh.nodes.front();
  Vector<Dim> high = low;
  for (const Vector<Dim>& x : mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double cells_per_metre = (last_cell + 1.0) / (high - low).maxCoeff();
  std::vector<std::uint64_t> positions;
  positions.reserve(mesh.elements.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Vector<Dim> x = (element_centroid(mesh, e) - low) * cells_per_metre;
    std::array<std::uint32_t, Dim> cell;
    for (int d = 0; d < Dim; ++d) {
      // Round-off can move the centroid of a flat element out of the square.
      cell[d] = static_cast<std::uint32_t>(std::clamp(x[d], 0.0, last_cell));
    }
    positions.push_back(hilbert_position<Dim>(cell, level));
  }
  return positions;
}

/// Former numbers of the elements, in the new order.
template <int Dim>
std::vector<int> element_order(const Mesh<Dim>& mesh) {
  const std::vector<std::uint64_t> positions = element_positions(mesh);
  std::vector<std::pair<std::uint64_t, int>> keys;
  keys.reserve(positions.size());
  for (const std::uint64_t position : positions) {
    keys.emplace_back(position, static_cast<int>(keys.size()));
  }
  std::ranges::sort(keys);
  std::vector<int> order;
  order.reserve(keys.size());
  for (const auto& [position, element] : keys) order.push_back(element);
  return order;
}

/// Sorts faces by their nodes. The two sides of a slit stay together.
template <int Dim>
void sort_faces(BoundarySet<Dim>& set, bool in_pairs) {
  if (!in_pairs) {
    std::ranges::sort(set.faces);
    return;
  }
  std::vector<std::array<std::array<int, Dim>, 2>> pairs;
  for (std::size_t i = 0; i < set.faces.size(); i += 2) {
    const auto [first, second] = std::minmax({set.faces[i], set.faces[i + 1]});
    pairs.push_back({first, second});
  }
  std::ranges::sort(pairs);
  set.faces.clear();
  for (const auto& pair : pairs) set.faces.insert(set.faces.end(), pair.begin(), pair.end());
}

}  // namespace

template <int Dim>
std::uint64_t hilbert_position(std::array<std::uint32_t, Dim> cell, int level) {
  // The curve in a cell is the whole curve, mirrored or turned. This is undone from the coarsest
  // level on: each digit of the coordinates transforms all finer digits.
  for (std::uint32_t bit = 1U << (level - 1); bit > 1; bit >>= 1) {
    const std::uint32_t finer = bit - 1;
    for (int d = 0; d < Dim; ++d) {
      if ((cell[d] & bit) != 0) {
        cell[0] ^= finer;
      } else {
        const std::uint32_t different = (cell[0] ^ cell[d]) & finer;
        cell[0] ^= different;
        cell[d] ^= different;
      }
    }
  }
  // Within a cell the curve follows the Gray code, of which one digit changes per step.
  for (int d = 1; d < Dim; ++d) cell[d] ^= cell[d - 1];
  std::uint32_t flipped = 0;
  for (std::uint32_t bit = 1U << (level - 1); bit > 1; bit >>= 1) {
    if ((cell[Dim - 1] & bit) != 0) flipped ^= bit - 1;
  }
  std::uint64_t position = 0;
  for (int digit = level - 1; digit >= 0; --digit) {
    for (int d = 0; d < Dim; ++d) {
      position = 2 * position + (((cell[d] ^ flipped) >> digit) & 1U);
    }
  }
  return position;
}

template <int Dim>
Mesh<Dim> in_hilbert_order(const Mesh<Dim>& mesh) {
  Mesh<Dim> ordered;
  ordered.region_names = mesh.region_names;
  ordered.boundaries = mesh.boundaries;
  ordered.nodes.reserve(mesh.nodes.size());
  ordered.elements.reserve(mesh.elements.size());
  ordered.element_region.reserve(mesh.elements.size());
  std::vector<int> new_number(mesh.nodes.size(), -1);
  for (const int e : element_order(mesh)) {
    std::array<int, Dim + 1> corners = mesh.elements[e];
    for (int& node : corners) {
      int& number = new_number[node];
      if (number < 0) {
        number = ordered.node_count();
        ordered.nodes.push_back(mesh.nodes[node]);
      }
      node = number;
    }
    ordered.elements.push_back(corners);
    ordered.element_region.push_back(mesh.element_region[e]);
  }
  for (BoundarySet<Dim>& set : ordered.boundaries) {
    for (auto& face : set.faces) {
      for (int& node : face) node = new_number[node];
      face = face_key<Dim>(face);
    }
    sort_faces(set, is_slit(ordered, set));
  }
  return ordered;
}

template std::uint64_t hilbert_position<2>(std::array<std::uint32_t, 2>, int);
template std::uint64_t hilbert_position<3>(std::array<std::uint32_t, 3>, int);
template Mesh<2> in_hilbert_order<2>(const Mesh<2>&);
template Mesh<3> in_hilbert_order<3>(const Mesh<3>&);

}  // namespace suffuse

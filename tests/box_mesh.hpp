#pragma once

/// Boxes of tetrahedra made in memory, for tests in three dimensions.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "case/case_file.hpp"
#include "grid/element_field.hpp"

namespace suffuse::model {

/// Displaces a node; without one, nodes stay.
using NodeMove = std::function<Vector<3>(const Vector<3>&)>;

/// [0, size] in cells[0] x cells[1] x cells[2] cuboids of six tetrahedra each, one for each order
/// of the axes in which a path along the edges leads from the cuboid's first corner to its last
/// (Kuhn, IBM J. Res. Dev. 4 (1960) 518). Region "specimen"; boundaries top and bottom (z), left
/// and right (x), front and back (y). `move` displaces nodes.
inline Mesh<3> box_mesh(
    const std::array<int, 3>& cells, const Vector<3>& size = Vector<3>::Ones(),
    const NodeMove& move = [](const Vector<3>& x) { return x; }) {
  using Index = std::array<int, 3>;
  Mesh<3> mesh;
  const auto node = [&](const Index& at) {
    return (at[2] * (cells[1] + 1) + at[1]) * (cells[0] + 1) + at[0];
  };
  const auto for_each = [](const Index& counts, const auto& visit) {
    for (int k = 0; k < counts[2]; ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        for (int i = 0; i < counts[0]; ++i) visit(Index{i, j, k});
      }
    }
  };
  for_each({cells[0] + 1, cells[1] + 1, cells[2] + 1}, [&](const Index& at) {
    Vector<3> x;
    for (int d = 0; d < 3; ++d) x[d] = size[d] * at[d] / cells[d];
    mesh.nodes.push_back(move(x));
  });
  mesh.boundaries = {{"left", {}}, {"right", {}},  {"front", {}},
                     {"back", {}}, {"bottom", {}}, {"top", {}}};
  for_each(cells, [&](const Index& cell) {
    Index axes{0, 1, 2};
    do {
      std::array<Index, 4> corners{cell, cell, cell, cell};
      for (int step = 0; step < 3; ++step) {
        for (int later = step + 1; later < 4; ++later) ++corners[later][axes[step]];
      }
      const bool even = (axes[1] + 3 - axes[0]) % 3 == 1;
      if (!even) std::swap(corners[2], corners[3]);
      mesh.elements.push_back(
          {node(corners[0]), node(corners[1]), node(corners[2]), node(corners[3])});
      // A side lies on a boundary when its three corners do.
      for (int d = 0; d < 3; ++d) {
        for (const int end : {0, 1}) {
          std::array<int, 4> side{};
          int count = 0;
          for (const Index& corner : corners) {
            if (corner[d] == end * cells[d]) side[count++] = node(corner);
          }
          if (count == 3) mesh.boundaries[2 * d + end].faces.push_back({side[0], side[1], side[2]});
        }
      }
    } while (std::next_permutation(axes.begin(), axes.end()));
  });
  mesh.element_region.assign(mesh.elements.size(), 0);
  mesh.region_names = {"specimen"};
  return mesh;
}

/// Displaces inner nodes of [0, size] by up to `amount` in each direction, by a smooth function of
/// no period: the same on every platform.
inline NodeMove disturbed(double amount, const Vector<3>& size = Vector<3>::Ones()) {
  return [amount, size](const Vector<3>& x) {
    Vector<3> moved = x;
    for (int d = 0; d < 3; ++d) {
      if (x[d] <= 0.0 || x[d] >= size[d]) continue;
      const double wave =
          1e3 * (x[0] * (d + 1) + x[1] * std::numbers::sqrt2 + x[2] * std::numbers::e);
      moved[d] += amount * std::sin(wave);
    }
    return moved;
  };
}

/// Solid points at the field nodes, which are the Gauss points of degree two, or one at each
/// centroid.
inline MaterialPoints<3> gauss_points(const Mesh<3>& mesh, int per_element) {
  MaterialPoints<3> points;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int j = 0; j < per_element; ++j) {
      std::array<double, 4> at;
      at.fill(per_element == 1 ? 0.25 : FieldNodes<3>::far_vertex);
      if (per_element > 1) at[j] = FieldNodes<3>::near_vertex;
      points.element.push_back(e);
      points.barycentric.push_back(at);
      points.volume.push_back(element_volume(mesh, e) / per_element);
    }
  }
  return points;
}

inline Case<3> make_case(Mesh<3> mesh, Scene scene) {
  Case<3> c;
  c.mesh = std::move(mesh);
  c.document.path = "model.toml";
  c.document.scene = std::move(scene);
  c.solid_points = gauss_points(c.mesh, c.document.scene.points.solid_per_element == 1 ? 1 : 4);
  return c;
}

}  // namespace suffuse::model

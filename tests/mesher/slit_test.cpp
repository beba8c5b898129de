#include "mesh/slit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "hilbert_order.hpp"
#include "mesh/faces.hpp"

namespace suffuse {
namespace slit_test {

using Edge = std::array<int, 2>;

/// Nodes of a square of `cells` by `cells` unit cells, by column and row.
int node(int cells, int i, int j) {
  return j * (cells + 1) + i;
}

/// [0, cells]^2 in unit cells of two right triangles, whose outer edges are the boundary "all".
Mesh<2> square(int cells) {
  Mesh<2> mesh;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) mesh.nodes.emplace_back(i, j);
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int corner = node(cells, i, j);
      const int above = node(cells, i, j + 1);
      mesh.elements.push_back({corner, corner + 1, above + 1});
      mesh.elements.push_back({corner, above + 1, above});
    }
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  mesh.region_names = {"soil"};
  BoundarySet<2> all{"all", {}};
  for (int i = 0; i < cells; ++i) {
    all.faces.push_back({node(cells, i, 0), node(cells, i + 1, 0)});
    all.faces.push_back({node(cells, i, cells), node(cells, i + 1, cells)});
    all.faces.push_back({node(cells, 0, i), node(cells, 0, i + 1)});
    all.faces.push_back({node(cells, cells, i), node(cells, cells, i + 1)});
  }
  mesh.boundaries = {all};
  return mesh;
}

/// The edges along nodes at these columns and rows.
BoundarySet<2> cut(const std::string& name, int cells,
                   const std::vector<std::pair<int, int>>& path) {
  BoundarySet<2> set{name, {}};
  for (std::size_t k = 1; k < path.size(); ++k) {
    set.faces.push_back({node(cells, path[k - 1].first, path[k - 1].second),
                         node(cells, path[k].first, path[k].second)});
  }
  return set;
}

/// Number of nodes at a place.
int nodes_at(const Mesh<2>& mesh, double x, double y) {
  return static_cast<int>(std::ranges::count(mesh.nodes, Vector<2>(x, y)));
}

/// Number of pieces of the mesh that are not connected by faces.
template <int Dim>
int pieces(const Mesh<Dim>& mesh) {
  std::vector<int> piece(mesh.elements.size());
  std::iota(piece.begin(), piece.end(), 0);
  const std::function<int(int)> root = [&](int e) { return piece[e] == e ? e : root(piece[e]); };
  std::map<std::array<int, Dim>, int> owner;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int corner = 0; corner <= Dim; ++corner) {
      const auto [entry, is_new] =
          owner.emplace(face_key<Dim>(face_opposite<Dim>(mesh.elements[e], corner)), e);
      if (!is_new) piece[root(e)] = root(entry->second);
    }
  }
  std::set<int> roots;
  for (int e = 0; e < mesh.element_count(); ++e) roots.insert(root(e));
  return static_cast<int>(roots.size());
}

/// What holds of every cut: elements stay where they are, each face of a cut becomes two outer
/// faces at the same place, all other faces keep their owners, and old boundaries stay outer.
template <int Dim>
void expect_slit(const Mesh<Dim>& before, const Mesh<Dim>& after,
                 const std::vector<BoundarySet<Dim>>& cuts) {
  ASSERT_EQ(after.elements.size(), before.elements.size());
  for (int e = 0; e < before.element_count(); ++e) {
    for (int a = 0; a <= Dim; ++a) {
      EXPECT_EQ(after.nodes[after.elements[e][a]], before.nodes[before.elements[e][a]]);
    }
  }
  std::set<std::array<int, Dim>> cut_faces;
  for (const auto& set : cuts) {
    for (const auto& face : set.faces) cut_faces.insert(face_key<Dim>(face));
  }
  const FaceTable<Dim> old_faces(before);
  const FaceTable<Dim> new_faces(after);
  for (int e = 0; e < before.element_count(); ++e) {
    for (int corner = 0; corner <= Dim; ++corner) {
      const auto old_face = face_opposite<Dim>(before.elements[e], corner);
      const auto new_face = face_opposite<Dim>(after.elements[e], corner);
      const bool is_cut = cut_faces.contains(face_key<Dim>(old_face));
      EXPECT_EQ(new_faces.owners(new_face), is_cut ? 1 : old_faces.owners(old_face));
    }
  }
  ASSERT_EQ(after.boundaries.size(), before.boundaries.size() + cuts.size());
  for (std::size_t b = 0; b < after.boundaries.size(); ++b) {
    for (const auto& face : after.boundaries[b].faces) EXPECT_EQ(new_faces.owners(face), 1);
    EXPECT_EQ(is_slit(after, after.boundaries[b]), b >= before.boundaries.size());
  }
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    const auto& sides = after.boundaries[before.boundaries.size() + k];
    EXPECT_EQ(sides.name, cuts[k].name);
    ASSERT_EQ(sides.faces.size(), 2 * cuts[k].faces.size());
    for (std::size_t i = 0; i < cuts[k].faces.size(); ++i) {
      for (const std::size_t side : {2 * i, 2 * i + 1}) {
        std::multiset<std::array<double, Dim>> was;
        std::multiset<std::array<double, Dim>> is;
        const auto place = [](const Vector<Dim>& x) {
          std::array<double, Dim> result;
          std::copy(x.begin(), x.end(), result.begin());
          return result;
        };
        for (const int n : cuts[k].faces[i]) was.insert(place(before.nodes[n]));
        for (const int n : sides.faces[side]) is.insert(place(after.nodes[n]));
        EXPECT_EQ(is, was);
      }
    }
  }
}

/// Cuts the square and checks what holds of every cut.
Mesh<2> slit_square(int cells, const std::vector<BoundarySet<2>>& cuts) {
  const Mesh<2> before = square(cells);
  Mesh<2> after = before;
  EXPECT_TRUE(slit(after, cuts).empty());
  expect_slit(before, after, cuts);
  return after;
}

TEST(Slit, leaves_tips_in_the_soil_single) {
  const Mesh<2> mesh = slit_square(4, {cut("wall", 4, {{1, 2}, {2, 2}, {3, 2}})});
  EXPECT_EQ(mesh.node_count(), 25 + 1);
  EXPECT_EQ(nodes_at(mesh, 1, 2), 1);
  EXPECT_EQ(nodes_at(mesh, 2, 2), 2);
  EXPECT_EQ(nodes_at(mesh, 3, 2), 1);
  EXPECT_EQ(pieces(mesh), 1);
}

TEST(Slit, doubles_an_end_at_the_boundary) {
  const Mesh<2> mesh = slit_square(4, {cut("pile", 4, {{2, 4}, {2, 3}, {2, 2}})});
  EXPECT_EQ(nodes_at(mesh, 2, 4), 2);
  EXPECT_EQ(nodes_at(mesh, 2, 3), 2);
  EXPECT_EQ(nodes_at(mesh, 2, 2), 1);
  EXPECT_EQ(pieces(mesh), 1);
  // A single edge is enough if one of its ends is on the boundary.
  EXPECT_EQ(nodes_at(slit_square(4, {cut("short", 4, {{2, 4}, {2, 3}})}), 2, 4), 2);
}

TEST(Slit, goes_round_bends_and_along_diagonals) {
  const Mesh<2> mesh = slit_square(4, {cut("bent", 4, {{1, 1}, {2, 2}, {2, 3}, {3, 3}, {3, 2}})});
  EXPECT_EQ(mesh.node_count(), 25 + 3);
  EXPECT_EQ(pieces(mesh), 1);
}

TEST(Slit, parts_all_quarters_of_a_crossing) {
  const Mesh<2> mesh = slit_square(
      4, {cut("across", 4, {{1, 2}, {2, 2}, {3, 2}}), cut("along", 4, {{2, 1}, {2, 2}, {2, 3}})});
  EXPECT_EQ(nodes_at(mesh, 2, 2), 4);
  EXPECT_EQ(mesh.node_count(), 25 + 3);
  const Mesh<2> joint = slit_square(
      4, {cut("across", 4, {{1, 2}, {2, 2}, {3, 2}}), cut("along", 4, {{2, 2}, {2, 3}})});
  EXPECT_EQ(nodes_at(joint, 2, 2), 3);
}

TEST(Slit, cuts_a_closed_curve_out_and_a_mesh_in_two) {
  const BoundarySet<2> ring =
      cut("ring", 4, {{1, 1}, {2, 1}, {3, 1}, {3, 2}, {3, 3}, {2, 3}, {1, 3}, {1, 2}, {1, 1}});
  EXPECT_EQ(pieces(slit_square(4, {ring})), 2);
  const Mesh<2> halves = slit_square(4, {cut("half", 4, {{2, 0}, {2, 1}, {2, 2}, {2, 3}, {2, 4}})});
  EXPECT_EQ(pieces(halves), 2);
  EXPECT_EQ(halves.node_count(), 25 + 5);
}

TEST(Slit, says_which_face_stays_joined) {
  Mesh<2> mesh = square(4);
  const auto joined = slit(mesh, {cut("one", 4, {{1, 2}, {2, 2}})});
  ASSERT_EQ(joined.size(), 1U);
  EXPECT_EQ(joined[0].name, "one");
  EXPECT_EQ(mesh.node_count(), 25);
}

TEST(Slit, keeps_its_pairs_when_the_mesh_is_numbered_anew) {
  const Mesh<2> mesh = slit_square(6, {cut("wall", 6, {{1, 2}, {2, 2}, {3, 2}, {4, 2}, {4, 3}}),
                                       cut("top", 6, {{3, 6}, {3, 5}})});
  const Mesh<2> ordered = in_hilbert_order(mesh);
  EXPECT_FALSE(is_slit(ordered, ordered.boundaries[0]));
  EXPECT_TRUE(is_slit(ordered, ordered.boundaries[1]));
  EXPECT_TRUE(is_slit(ordered, ordered.boundaries[2]));
  EXPECT_EQ(ordered.boundaries[1].faces.size(), 8U);
}

/// A box of cells, each in six tetrahedra around its diagonal.
Mesh<3> box(int cells) {
  Mesh<3> mesh;
  const auto at = [&](const std::array<int, 3>& x) {
    return (x[2] * (cells + 1) + x[1]) * (cells + 1) + x[0];
  };
  for (int k = 0; k <= cells; ++k) {
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) mesh.nodes.emplace_back(i, j, k);
    }
  }
  for (int k = 0; k < cells; ++k) {
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < cells; ++i) {
        std::array<int, 3> axes{0, 1, 2};
        do {
          std::array<int, 3> x{i, j, k};
          std::array<int, 4> corners{at(x)};
          for (int step = 0; step < 3; ++step) {
            ++x[axes[step]];
            corners[step + 1] = at(x);
          }
          mesh.elements.push_back(corners);
        } while (std::ranges::next_permutation(axes).found);
      }
    }
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  mesh.region_names = {"soil"};
  return mesh;
}

/// The faces in the plane z = 2 of a box of four cells, all or those at its middle.
BoundarySet<3> disc(const Mesh<3>& mesh, bool all) {
  std::set<std::array<int, 3>> faces;
  const auto in_plane = [&](int n) { return mesh.nodes[n][2] == 2.0; };
  const auto in_middle = [&](int n) { return mesh.nodes[n] == Vector<3>(2.0, 2.0, 2.0); };
  for (const auto& corners : mesh.elements) {
    for (int corner = 0; corner < 4; ++corner) {
      const auto face = face_key<3>(face_opposite<3>(corners, corner));
      if (!std::ranges::all_of(face, in_plane)) continue;
      if (all || std::ranges::any_of(face, in_middle)) faces.insert(face);
    }
  }
  return {"disc", {faces.begin(), faces.end()}};
}

TEST(Slit, works_in_three_dimensions) {
  const Mesh<3> before = box(4);
  Mesh<3> inner = before;
  const std::vector<BoundarySet<3>> small{disc(before, false)};
  EXPECT_TRUE(slit(inner, small).empty());
  expect_slit(before, inner, small);
  EXPECT_EQ(inner.node_count(), before.node_count() + 1);  // the rim stays single
  EXPECT_EQ(pieces(inner), 1);
  Mesh<3> halves = before;
  const std::vector<BoundarySet<3>> whole{disc(before, true)};
  EXPECT_TRUE(slit(halves, whole).empty());
  expect_slit(before, halves, whole);
  EXPECT_EQ(halves.node_count(), before.node_count() + 25);
  EXPECT_EQ(pieces(halves), 2);
}

}  // namespace slit_test
}  // namespace suffuse

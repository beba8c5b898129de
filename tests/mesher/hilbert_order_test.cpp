#include "hilbert_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "column.hpp"
#include "gmsh_session.hpp"
#include "mesh/faces.hpp"
#include "mesh_extraction.hpp"
#include "mesher/shuffled_mesh.hpp"

namespace suffuse {
namespace hilbert_order_test {

// The curve

/// Coordinates of the cells of a grid, by position on the curve. Fails where a position is missing
/// or there twice.
template <int Dim>
std::vector<std::array<std::uint32_t, Dim>> cells_along_the_curve(int level) {
  const std::uint64_t count = std::uint64_t{1} << (Dim * level);
  std::vector<std::array<std::uint32_t, Dim>> cells(count);
  std::vector<int> visits(count, 0);
  for (std::uint64_t c = 0; c < count; ++c) {
    std::array<std::uint32_t, Dim> cell{};
    for (int d = 0; d < Dim; ++d) {
      cell[d] = static_cast<std::uint32_t>(c >> (d * level)) & ((1U << level) - 1U);
    }
    const std::uint64_t position = hilbert_position<Dim>(cell, level);
    ++visits.at(position);
    cells[position] = cell;
  }
  EXPECT_EQ(visits, std::vector<int>(count, 1));
  return cells;
}

template <class Cell>
int steps_between(const Cell& a, const Cell& b) {
  int steps = 0;
  for (std::size_t d = 0; d < a.size(); ++d) {
    steps += std::abs(static_cast<int>(a[d]) - static_cast<int>(b[d]));
  }
  return steps;
}

template <int Dim>
void expect_steps_of_one_cell(int finest) {
  for (int level = 1; level <= finest; ++level) {
    const auto cells = cells_along_the_curve<Dim>(level);
    for (std::size_t i = 1; i < cells.size(); ++i) {
      ASSERT_EQ(steps_between(cells[i - 1], cells[i]), 1) << "level " << level << ", step " << i;
    }
    std::array<std::uint32_t, Dim> last{};
    EXPECT_EQ(cells.front(), last);
    last[0] = (1U << level) - 1U;  // the curve ends next to its start
    EXPECT_EQ(cells.back(), last);
  }
}

TEST(HilbertCurve, VisitsEverySquareOnceInStepsOfOne) {
  expect_steps_of_one_cell<2>(7);
}

TEST(HilbertCurve, VisitsEveryCubeOnceInStepsOfOne) {
  expect_steps_of_one_cell<3>(5);
}

template <int Dim>
void expect_coarse_to_be_prefix_of_fine() {
  constexpr int finest = finest_hilbert_level<Dim>;
  std::mt19937_64 random(7);
  for (int i = 0; i < 100; ++i) {
    std::array<std::uint32_t, Dim> cell{};
    for (auto& x : cell) x = static_cast<std::uint32_t>(random()) & ((1U << finest) - 1U);
    const std::uint64_t fine = hilbert_position<Dim>(cell, finest);
    for (int level = finest - 1; level > 0; --level) {
      std::array<std::uint32_t, Dim> coarse = cell;
      for (auto& x : coarse) x >>= finest - level;
      ASSERT_EQ(hilbert_position<Dim>(coarse, level), fine >> (Dim * (finest - level))) << level;
    }
  }
}

TEST(HilbertCurve, OfACoarserGridIsTheSameSeenFromAfar) {
  expect_coarse_to_be_prefix_of_fine<2>();
  expect_coarse_to_be_prefix_of_fine<3>();
}

TEST(HilbertCurve, HasItsEndsInCornersOfTheFinestGridToo) {
  const std::uint32_t last = (1U << 31U) - 1U;
  EXPECT_EQ(hilbert_position<2>({0, 0}, 31), 0U);
  EXPECT_EQ(hilbert_position<2>({last, 0}, 31), (std::uint64_t{1} << 62U) - 1U);
  const std::uint32_t last_cube = (1U << 21U) - 1U;
  EXPECT_EQ(hilbert_position<3>({last_cube, 0, 0}, 21), (std::uint64_t{1} << 63U) - 1U);
}

// The order of a mesh

/// Gmsh's column in Gmsh's order, 1 m wide.
Mesh<2> gmsh_column(double size, MeshStructure structure, double height = 1.0) {
  const GmshSession session;
  Scene scene;
  scene.geometry.width = 1.0;
  scene.geometry.height = height;
  scene.mesh.size = size;
  scene.mesh.structure = structure;
  const std::string complaint = gmsh_complaint([&] { mesh_column(column_of(scene), scene.mesh); });
  EXPECT_EQ(complaint, "");
  ExtractedMesh extracted = extract_mesh<2>(
      read_gmsh_model(), structure == MeshStructure::crossed ? Quadrangles::cut_along_diagonals
                                                             : Quadrangles::refused);
  EXPECT_TRUE(extracted.problems.empty());
  return std::move(extracted.mesh);
}

/// The unit cube in n x n x n cubes of six tetrahedra along a diagonal each (H. Freudenthal).
Mesh<3> cube(int n) {
  Mesh<3> mesh;
  const auto node = [&](const std::array<int, 3>& at) {
    return (at[2] * (n + 1) + at[1]) * (n + 1) + at[0];
  };
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) mesh.nodes.emplace_back(Vector<3>(i, j, k) / n);
    }
  }
  for (int c = 0; c < n * n * n; ++c) {
    std::array<int, 3> axes{0, 1, 2};
    do {
      std::array<int, 3> at{c % n, c / n % n, c / n / n};
      std::array<int, 4> corners{node(at)};
      for (int a = 0; a < 3; ++a) {
        ++at[axes[a]];
        corners[a + 1] = node(at);
      }
      mesh.elements.push_back(corners);
      if (element_volume(mesh, mesh.element_count() - 1) < 0.0) {
        std::swap(mesh.elements.back()[2], mesh.elements.back()[3]);
      }
    } while (std::ranges::next_permutation(axes).found);
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  mesh.region_names = {"specimen"};
  return mesh;
}

template <int Dim>
void expect_equal(const Mesh<Dim>& a, const Mesh<Dim>& b) {
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.elements, b.elements);
  EXPECT_EQ(a.element_region, b.element_region);
  EXPECT_EQ(a.region_names, b.region_names);
  ASSERT_EQ(a.boundaries.size(), b.boundaries.size());
  for (std::size_t i = 0; i < a.boundaries.size(); ++i) {
    EXPECT_EQ(a.boundaries[i].name, b.boundaries[i].name);
    EXPECT_EQ(a.boundaries[i].faces, b.boundaries[i].faces);
  }
}

template <int Dim>
bool are_numbered_by_first_use(const Mesh<Dim>& mesh) {
  int next = 0;
  for (const auto& corners : mesh.elements) {
    for (const int node : corners) {
      if (node > next) return false;
      next += node == next ? 1 : 0;
    }
  }
  return next == mesh.node_count();
}

/// Everything in a mesh without its numbers: corners of the elements in their order with the
/// region, ends of the outer edges with the boundary.
using Place = std::vector<double>;
std::multiset<std::pair<Place, std::string>> contents(const Mesh<2>& mesh) {
  std::multiset<std::pair<Place, std::string>> contents;
  for (int e = 0; e < mesh.element_count(); ++e) {
    Place corners;
    for (const int node : mesh.elements[e]) {
      corners.insert(corners.end(), {mesh.nodes[node][0], mesh.nodes[node][1]});
    }
    contents.emplace(corners, mesh.region_names[mesh.element_region[e]]);
  }
  for (const auto& set : mesh.boundaries) {
    for (const auto& face : set.faces) {
      Place a{mesh.nodes[face[0]][0], mesh.nodes[face[0]][1]};
      Place b{mesh.nodes[face[1]][0], mesh.nodes[face[1]][1]};
      if (b < a) std::swap(a, b);
      contents.emplace(Place{a[0], a[1], b[0], b[1]}, set.name);
    }
  }
  return contents;
}

TEST(HilbertOrder, ChangesNothingButNumbers) {
  Mesh<2> mesh = gmsh_column(0.1, MeshStructure::free);
  mesh.region_names.emplace_back("above");
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = element_centroid(mesh, e)[1] > 0.6 ? 1 : 0;
  }
  const Mesh<2> ordered = in_hilbert_order(mesh);
  EXPECT_NE(ordered.elements, mesh.elements);
  EXPECT_EQ(contents(ordered), contents(mesh));
  for (const auto& set : ordered.boundaries) {
    EXPECT_TRUE(std::ranges::is_sorted(set.faces)) << set.name;
    for (const auto& face : set.faces) EXPECT_LT(face[0], face[1]) << set.name;
  }
}

TEST(HilbertOrder, DependsOnPlacesAndNotOnFormerNumbers) {
  const Mesh<2> mesh = gmsh_column(0.1, MeshStructure::free);
  const Mesh<2> ordered = in_hilbert_order(mesh);
  expect_equal(in_hilbert_order(test::shuffled(mesh)), ordered);
  expect_equal(in_hilbert_order(ordered), ordered);
  expect_equal(in_hilbert_order(in_hilbert_order(cube(4))), in_hilbert_order(cube(4)));
}

TEST(HilbertOrder, NumbersNodesByFirstUse) {
  const Mesh<2> mesh = gmsh_column(0.1, MeshStructure::crossed);
  EXPECT_FALSE(are_numbered_by_first_use(mesh));
  EXPECT_TRUE(are_numbered_by_first_use(in_hilbert_order(mesh)));
  EXPECT_TRUE(are_numbered_by_first_use(in_hilbert_order(cube(3))));
}

TEST(HilbertOrder, LeavesElementsOfOnePlaceInTheirOrder) {
  Mesh<2> mesh;
  mesh.nodes = {{0, 0}, {1, 0}, {0, 1}};
  mesh.elements.assign(40, {0, 1, 2});
  mesh.region_names = {"a", "b"};
  for (int e = 0; e < 40; ++e) mesh.element_region.push_back(e * e % 7 % 2);
  EXPECT_EQ(in_hilbert_order(mesh).element_region, mesh.element_region);
}

template <int Dim>
std::array<int, Dim> cell_of(const Mesh<Dim>& mesh, int element, int cells) {
  const Vector<Dim> x = element_centroid(mesh, element) * cells;
  std::array<int, Dim> cell{};
  for (int d = 0; d < Dim; ++d) cell[d] = static_cast<int>(std::floor(x[d]));
  return cell;
}

/// From an element to the next, within a cell of the grid or into the neighbouring one.
template <int Dim>
void expect_elements_to_follow_cells(const Mesh<Dim>& mesh, int cells) {
  for (int e = 1; e < mesh.element_count(); ++e) {
    ASSERT_LE(steps_between(cell_of(mesh, e - 1, cells), cell_of(mesh, e, cells)), 1) << e;
  }
}

TEST(HilbertOrder, GoesFromCellToCellOfARegularMesh) {
  for (const MeshStructure structure : {MeshStructure::regular, MeshStructure::crossed}) {
    expect_elements_to_follow_cells(in_hilbert_order(gmsh_column(1.0 / 16, structure)), 16);
  }
  expect_elements_to_follow_cells(in_hilbert_order(cube(8)), 8);
}

/// Pairs of elements that share a face.
std::vector<std::array<int, 2>> neighbours(const Mesh<2>& mesh) {
  std::map<std::array<int, 2>, int> first;
  std::vector<std::array<int, 2>> pairs;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto face = face_key<2>(face_opposite<2>(mesh.elements[e], corner));
      const auto [entry, is_new] = first.emplace(face, e);
      if (!is_new) pairs.push_back({entry->second, e});
    }
  }
  return pairs;
}

/// Mean difference of the numbers of neighbours.
double mean_distance(const Mesh<2>& mesh) {
  const auto pairs = neighbours(mesh);
  double sum = 0.0;
  for (const auto& [a, b] : pairs) sum += std::abs(a - b);
  return sum / static_cast<double>(pairs.size());
}

/// Number of faces between `parts` parts of equally many consecutive elements.
int cut_faces(const Mesh<2>& mesh, int parts) {
  const auto pairs = neighbours(mesh);
  const auto part = [&](int e) {
    return static_cast<std::int64_t>(e) * parts / mesh.element_count();
  };
  return static_cast<int>(
      std::ranges::count_if(pairs, [&](const auto& p) { return part(p[0]) != part(p[1]); }));
}

/// In Gmsh's order neighbours are a fixed share of all numbers apart.
TEST(HilbertOrder, NumbersOfNeighboursDifferAsTheSquareRootOfAll) {
  for (const double size : {0.04, 0.02, 0.01}) {
    const Mesh<2> mesh = gmsh_column(size, MeshStructure::free);
    const double count = mesh.element_count();
    EXPECT_GT(mean_distance(mesh), 0.1 * count) << size;
    EXPECT_LT(mean_distance(in_hilbert_order(mesh)), 0.75 * std::sqrt(count)) << size;
  }
}

/// A stretch of the curve of area A reaches no farther than sqrt(6 A): five side lengths if three
/// elements' worth of it are without a centroid.
TEST(HilbertOrder, EveryElementFollowsANearOne) {
  const Mesh<2> mesh = in_hilbert_order(gmsh_column(0.02, MeshStructure::free));
  const double side = std::sqrt(1.0 / mesh.element_count());
  double sum = 0.0;
  for (int e = 1; e < mesh.element_count(); ++e) {
    const double step = (element_centroid(mesh, e) - element_centroid(mesh, e - 1)).norm();
    EXPECT_LT(step, 5.0 * side) << e;
    sum += step;
  }
  EXPECT_LT(sum / mesh.element_count(), 1.2 * side);
}

TEST(HilbertOrder, PartsOfConsecutiveElementsHaveShortBorders) {
  // A regular mesh of 16 x 16 squares falls into 4 x 4 squares: six lines of 16 edges between them.
  const Mesh<2> regular = in_hilbert_order(gmsh_column(1.0 / 16, MeshStructure::regular));
  EXPECT_EQ(cut_faces(regular, 16), 6 * 16);
  // As many lines through equilateral triangles, along their edges, cut 4 edges per sqrt(count).
  const Mesh<2> mesh = gmsh_column(0.01, MeshStructure::free);
  const double straight = 6.0 * std::sqrt(mesh.element_count() * std::sqrt(3.0) / 4.0);
  EXPECT_LT(cut_faces(in_hilbert_order(mesh), 16), 1.5 * straight);
  EXPECT_GT(cut_faces(mesh, 16), 10.0 * straight);
}

}  // namespace hilbert_order_test
}  // namespace suffuse

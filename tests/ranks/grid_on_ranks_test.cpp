/// A rank's part of a grid against the grid of the whole mesh: equal to the last bit, but for faces
/// and nodes whose elements it does not hold.

#include <gtest/gtest.h>

#include <algorithm>

#include "box_mesh.hpp"
#include "common/errors.hpp"
#include "grid/grid.hpp"
#include "ordered_mesh.hpp"
#include "ranks/local_part.hpp"
#include "ranks/mpi_ranks.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace grid_on_ranks_test {

template <int Dim>
struct Part {
  explicit Part(const Mesh<Dim>& whole, const std::shared_ptr<const Ranks>& ranks)
      : local(local_mesh(whole, ranks->rank(), ranks->count())),
        part(local.numbers),
        grid(local.mesh, {ranks, part}) {}

  LocalMesh<Dim> local;
  const PartNumbers& part;
  Grid<Dim> grid;
};

/// Number in the whole mesh of a face of the part.
template <int Dim>
int face_of_whole(const Grid<Dim>& whole, const Part<Dim>& p, int face) {
  std::array<int, Dim> nodes;
  for (int a = 0; a < Dim; ++a) {
    nodes[a] = static_cast<int>(p.part.node[p.grid.face_nodes[face][a]]);
  }
  return whole.find_face(nodes);
}

template <int Dim>
void expect_part_of(const Mesh<Dim>& mesh) {
  const Grid<Dim> whole(mesh);
  const auto ranks = mpi_ranks();
  const Part<Dim> p(mesh, ranks);
  const Grid<Dim>& grid = p.grid;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const auto global = static_cast<std::size_t>(p.part.element[e]);
    EXPECT_EQ(grid.volume[e], whole.volume[global]);
    EXPECT_EQ(grid.shape_gradient[e], whole.shape_gradient[global]);
    EXPECT_EQ(grid.element_face_sign[e], whole.element_face_sign[global]);
    for (int k = 0; k <= Dim; ++k) {
      EXPECT_EQ(face_of_whole(whole, p, grid.element_face[e][k]), whole.element_face[global][k]);
    }
  }
  for (int f = 0; f < grid.face_count(); ++f) {
    const int global = face_of_whole(whole, p, f);
    EXPECT_EQ(grid.face_normal[f], whole.face_normal[global]);
    EXPECT_EQ(grid.is_border(f), whole.is_border(global));
    if (!grid.owns_face(f)) continue;
    EXPECT_EQ(p.part.element[grid.face_left[f]], whole.face_left[global]);
    EXPECT_EQ(grid.is_outer(f), whole.is_outer(global));
  }
  for (int i = 0; i < grid.mesh.node_count(); ++i) {
    const auto global = static_cast<std::size_t>(p.part.node[i]);
    EXPECT_EQ(grid.node_volume[i], whole.node_volume[global]);
    if (!grid.node_rows().owns(i)) continue;
    // The elements of an own node are all here, in their order.
    const int begin = whole.node_element_begin[global];
    const int count = whole.node_element_begin[global + 1] - begin;
    ASSERT_EQ(grid.node_element_begin[i + 1] - grid.node_element_begin[i], count);
    for (int j = 0; j < count; ++j) {
      EXPECT_EQ(p.part.element[grid.node_element[grid.node_element_begin[i] + j]],
                whole.node_element[begin + j]);
    }
  }
}

/// Each rank owns its rows alone, all together own all, and copies have the values of their owners.
template <int Dim>
void expect_rows_of(const Mesh<Dim>& mesh) {
  const Grid<Dim> whole(mesh);
  const auto ranks = mpi_ranks();
  const Part<Dim> p(mesh, ranks);
  std::array<ExactSum, 3> owned;
  const auto check = [&](const OwnRows& rows, int count, ExactSum& sum, const auto& global) {
    std::vector<std::array<long, 2>> values(static_cast<std::size_t>(count), {-1, -1});
    for (const int row : rows.own()) {
      values[static_cast<std::size_t>(row)] = {global(row), 7 * global(row)};
      sum.add(1.0);
    }
    rows.exchange(values);
    for (int row = 0; row < count; ++row) {
      const long number = global(row);
      EXPECT_EQ(values[static_cast<std::size_t>(row)], (std::array<long, 2>{number, 7 * number}));
    }
  };
  const Grid<Dim>& grid = p.grid;
  check(grid.element_rows(), grid.mesh.element_count(), owned[0],
        [&](int e) { return p.part.element[e]; });
  check(grid.face_rows(), grid.face_count(), owned[1],
        [&](int f) { return static_cast<long>(face_of_whole(whole, p, f)); });
  check(grid.node_rows(), grid.mesh.node_count(), owned[2], [&](int i) { return p.part.node[i]; });
  grid.ranks().sum({&owned[0], &owned[1], &owned[2]});
  EXPECT_EQ(owned[0].value(), whole.mesh.element_count());
  EXPECT_EQ(owned[1].value(), whole.face_count());
  EXPECT_EQ(owned[2].value(), whole.mesh.node_count());
}

/// Boundary faces of own elements are here, each once over all ranks.
template <int Dim>
void expect_boundaries_of(const Mesh<Dim>& mesh) {
  const auto ranks = mpi_ranks();
  const Part<Dim> p(mesh, ranks);
  for (std::size_t b = 0; b < mesh.boundaries.size(); ++b) {
    ExactSum own;
    for (const auto& face : p.local.mesh.boundaries[b].faces) {
      const int f = p.grid.find_face(face);
      ASSERT_GE(f, 0);
      if (p.grid.owns_face(f)) own.add(1.0);
    }
    ranks->sum({&own});
    EXPECT_EQ(own.value(), static_cast<double>(mesh.boundaries[b].faces.size()));
  }
}

Mesh<2> square() {
  return in_order(model::column_mesh(9, 7, 1.0, 1.0, model::jittered(0.03, 2)));
}
Mesh<3> cube() {
  return in_order(model::box_mesh({4, 3, 5}));
}

TEST(GridOnRanks, IsAPartOfTheWholeGrid) {
  expect_part_of(square());
  expect_part_of(cube());
}

TEST(GridOnRanks, HasRowsThatAreOwnedOnce) {
  expect_rows_of(square());
  expect_rows_of(cube());
}

TEST(GridOnRanks, HasTheBoundariesOfItsElements) {
  expect_boundaries_of(square());
  expect_boundaries_of(cube());
}

TEST(GridOnRanks, RefusesNodesInAnotherOrder) {
  const auto ranks = mpi_ranks();
  Mesh<2> mesh = square();
  std::swap(mesh.nodes[0], mesh.nodes[20]);
  for (auto& nodes : mesh.elements) {
    for (int& i : nodes) i = i == 0 ? 20 : i == 20 ? 0 : i;
  }
  EXPECT_THROW(local_mesh(mesh, ranks->rank(), ranks->count()), InputError);
  EXPECT_THROW(local_mesh(square(), 0, 1000), InputError);
}

}  // namespace grid_on_ranks_test
}  // namespace suffuse

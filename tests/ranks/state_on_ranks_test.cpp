/// The state of a run on ranks has the bytes of that of one process, whatever their number.

#include <gtest/gtest.h>

#include <stdexcept>

#include "ordered_mesh.hpp"
#include "ranks/mpi_ranks.hpp"
#include "solid/rank_state.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace state_on_ranks_test {

/// Elements have up to three points, so that ranks have other numbers of points than of elements.
Case<2> whole_case() {
  Case<2> c;
  c.mesh = in_order(model::column_mesh(9, 7, 1.0, 1.0, model::jittered(0.03, 2)));
  c.document.scene = model::paper_scene();
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    for (int p = 0; p < e % 4; ++p) {
      c.solid_points.element.push_back(e);
      c.solid_points.barycentric.push_back({0.5 - 0.1 * p, 0.3, 0.2 + 0.1 * p});
      c.solid_points.volume.push_back(1.0);
    }
  }
  return c;
}

/// Values that say where they are.
struct Values {
  Values(const Case<2>& c, const Grid<2>& grid) {
    for (int e = 0; e < c.mesh.element_count(); ++e) {
      of_elements.push_back(element_centroid(c.mesh, e)[0]);
    }
    for (int f = 0; f < grid.face_count(); ++f) {
      // As conditions of faces, the values are not all stored.
      of_faces.push_back({grid.face_centre(f)[1], 3});
    }
    for (const Vector<2>& x : c.mesh.nodes) of_nodes.push_back(x);
    for (int p = 0; p < c.solid_points.size(); ++p) {
      of_points.push_back(c.solid_points.position(c.mesh, p)[0]);
    }
  }
  void archive(StateArchive& archive) {
    archive(time, on_elements(of_elements), on_faces(of_faces), on_elements(empty),
            on_nodes(of_nodes), on_points(of_points), text);
  }
  [[nodiscard]] bool operator==(const Values&) const = default;

  struct OfFace {
    double height;
    int kept;
    void archive(StateArchive& archive) { archive(height); }
    [[nodiscard]] bool operator==(const OfFace&) const = default;
  };

  double time = 3.0;
  std::string text = "a warning";
  std::vector<double> of_elements, empty, of_points;
  std::vector<OfFace> of_faces;
  std::vector<Vector<2>> of_nodes;
};

/// The part of a rank.
struct Part {
  explicit Part(const Case<2>& whole)
      : ranks(mpi_ranks()),
        local(local_mesh(whole.mesh, ranks->rank(), ranks->count())),
        part{ranks, local.numbers},
        c(local_case(whole, std::move(local))),
        grid(c.mesh, part),
        soils(c),
        state(grid, soils) {}

  std::shared_ptr<const Ranks> ranks;
  LocalMesh<2> local;
  RankPart part;
  Case<2> c;
  Grid<2> grid;
  SoilMap<2> soils;
  RankState state;
};

TEST(StateOnRanks, HasTheBytesOfOneProcess) {
  const Case<2> whole = whole_case();
  Values alone(whole, Grid<2>(whole.mesh));
  StateArchive serial;
  serial(alone);
  const std::vector<std::uint8_t> bytes = serial.finish();
  const Part part(whole);
  Values values(part.c, part.grid);
  StateArchive shared(&part.state);
  shared(values);
  EXPECT_EQ(shared.finish(), part.ranks->rank() == 0 ? bytes : std::vector<std::uint8_t>());
}

TEST(StateOnRanks, GivesEachRankItsRows) {
  const Case<2> whole = whole_case();
  Values alone(whole, Grid<2>(whole.mesh));
  StateArchive serial;
  serial(alone);
  const std::vector<std::uint8_t> bytes = serial.finish();
  const Part part(whole);
  const Values values(part.c, part.grid);
  Values restored = values;
  restored.time = 0.0;
  restored.text.clear();
  restored.of_elements.clear();
  restored.of_points.assign(restored.of_points.size(), 0.0);
  for (Values::OfFace& face : restored.of_faces) face.height = -1.0;
  for (Vector<2>& x : restored.of_nodes) x.setZero();
  StateArchive archive(bytes, &part.state);
  archive(restored);
  EXPECT_NO_THROW(archive.finish());
  EXPECT_EQ(restored, values);
}

/// What ranks should share and do not is noticed: a reduction was forgotten.
TEST(StateOnRanks, MustBeSharedWhereItHasNoTag) {
  const Case<2> whole = whole_case();
  const Part part(whole);
  if (part.ranks->count() == 1) return;
  Values values(part.c, part.grid);
  values.time += part.ranks->rank() == part.ranks->count() - 1 ? 1e-15 : 0.0;
  StateArchive shared(&part.state);
  shared(values);
  EXPECT_THROW(static_cast<void>(shared.finish()), std::logic_error);
}

/// Sums of parts come back as one sum, on rank 0.
TEST(StateOnRanks, KeepsSums) {
  const auto ranks = mpi_ranks();
  ExactSum sum;
  sum.add(0.1 * (ranks->rank() + 1));
  ExactSum all;
  for (int r = 0; r < ranks->count(); ++r) all.add(0.1 * (r + 1));
  StateArchive kept;
  archive_sums(kept, *ranks, {&sum});
  EXPECT_EQ(sum.value(), 0.1 * (ranks->rank() + 1));
  StateArchive given(kept.finish());
  archive_sums(given, *ranks, {&sum});
  EXPECT_EQ(sum.value(), ranks->rank() == 0 ? all.value() : 0.0);
}

}  // namespace state_on_ranks_test
}  // namespace suffuse

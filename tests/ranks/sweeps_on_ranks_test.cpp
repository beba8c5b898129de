/// Sweeps of implicit transport on ranks have the bits of one process under a given flow, also
/// where liquid circulates through the parts of several ranks.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>

#include "field/field_transport.hpp"
#include "ordered_mesh.hpp"
#include "ranks/mpi_ranks.hpp"
#include "solid/rigid_skeleton.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace sweeps_on_ranks_test {

using Stream = std::function<double(const Vector<2>&)>;

/// Soil that erodes until the liquid is rich; elements have one to four points.
Case<2> whole_case() {
  Case<2> c;
  c.mesh = in_order(model::column_mesh(12, 12, 1.0, 1.0, model::jittered(0.02, 2)));
  Scene& scene = c.document.scene;
  scene = model::paper_scene();
  Soil& soil = scene.soils[0];
  soil.erosion.law = erosion_law("constant");
  soil.erosion.rate = 1e-2;
  soil.erosion.critical_concentration = 0.05;
  BoundaryCondition rich = model::pressure_on("top", 0.0);
  rich.concentration = 0.1;
  scene.boundaries = {rich};
  const Grid<2> grid(c.mesh);
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    const int count = 1 + e % 4;
    const double volume = grid.volume[e] / count;
    for (int p = 0; p < count; ++p) {
      c.solid_points.element.push_back(e);
      c.solid_points.barycentric.push_back({0.5 - 0.1 * p, 0.3, 0.2 + 0.1 * p});
      c.solid_points.volume.push_back(volume);
    }
  }
  return c;
}

/// Transport in a case or in a part of it, in a flow with this stream function.
struct Model {
  Model(Case<2> of, std::optional<RankPart> part)
      : c(std::move(of)),
        grid(part ? Grid<2>(c.mesh, *part) : Grid<2>(c.mesh)),
        values(c, grid),
        soils(c),
        skeleton(grid, soils, TimeSpan{0.0, 10.0}, 1),
        conditions(values.at(0.0)),
        transport(grid, soils, conditions, values,
                  {.scheme = TransportScheme::implicit_sweeps,
                   .implicit = {.end = 10.0, .tolerance = 1e-2}},
                  1),
        exchange(skeleton, [](PointFlows&) {}) {}

  void move(const Stream& stream, double start, double end) {
    FlowProgress flow;
    flow.end = end;
    for (int f = 0; f < grid.face_count(); ++f) {
      const auto& [a, b] = grid.face_nodes[f];
      const Vector<2> along = c.mesh.nodes[b] - c.mesh.nodes[a];
      const double volume = stream(c.mesh.nodes[b]) - stream(c.mesh.nodes[a]);
      const double side = along[0] * grid.face_normal[f][1] - along[1] * grid.face_normal[f][0];
      flow.volumes.liquid.push_back((end - start) * (side > 0.0 ? volume : -volume));
    }
    PointFlows flows;
    flows.start = start;
    flows.end = end;
    exchange.start_interval(std::move(flows));
    crossed = transport.move(start, flow, exchange);
  }
  /// Numbers of fines, pores and fluxes of own elements, points and faces, in the whole mesh's
  /// order.
  [[nodiscard]] std::vector<double> of_all() const {
    std::vector<double> own;
    for (const int e : grid.own_elements()) {
      for (const double fines : transport.state().fines_volume[e]) own.push_back(fines);
    }
    std::vector<double> result = gather_values(grid.ranks(), own);
    own.clear();
    for (const int p : soils.points_of(grid.own_elements())) own.push_back(skeleton.porosity()[p]);
    const std::vector<double> pores = gather_values(grid.ranks(), own);
    own.clear();
    for (const int f : grid.own_faces()) own.push_back(crossed[f]);
    const std::vector<double> fluxes = gather_values(grid.ranks(), own);
    result.insert(result.end(), pores.begin(), pores.end());
    result.insert(result.end(), fluxes.begin(), fluxes.end());
    return result;
  }

  Case<2> c;
  Grid<2> grid;
  BoundaryValues<2> values;
  SoilMap<2> soils;
  RigidSkeleton<2> skeleton;
  std::vector<FaceCondition> conditions;
  FieldTransport<2> transport;
  SolidExchange<2> exchange;
  std::vector<double> crossed;
};

/// A random number of a place, in [-1, 1).
double noise(const Vector<2>& x) {
  const double value = std::sin(12.9898 * x[0] + 78.233 * x[1]) * 43758.5453;
  return 2.0 * (value - std::floor(value)) - 1.0;
}
double through(const Vector<2>& x) {
  return 2e-2 * (x[0] + 0.3 * x[1] * x[1]);
}
double around(const Vector<2>& x) {
  return 0.1 * 16.0 * x[0] * (1.0 - x[0]) * x[1] * (1.0 - x[1]);
}

void expect_bits_of_one_process(const std::string& name, const std::vector<Stream>& streams) {
  const auto ranks = mpi_ranks();
  const Case<2> whole = whole_case();
  Model alone(whole, {});
  LocalMesh<2> local = local_mesh(whole.mesh, ranks->rank(), ranks->count());
  const RankPart part{ranks, local.numbers};
  Model shared(local_case(whole, std::move(local)), part);
  double time = 0.0;
  for (const Stream& stream : streams) {
    alone.move(stream, time, time + 1.0);
    shared.move(stream, time, time + 1.0);
    time += 1.0;
    const std::vector<double> found = shared.of_all();
    if (ranks->rank() != 0) continue;
    const std::vector<double> expected = alone.of_all();
    ASSERT_EQ(found.size(), expected.size()) << name;
    std::size_t differ = 0;
    for (std::size_t i = 0; i < found.size(); ++i) differ += found[i] != expected[i] ? 1 : 0;
    EXPECT_EQ(differ, 0U) << name << " at " << time;
  }
}

TEST(SweepsOnRanks, HaveTheBitsOfOneProcessAlongAFlow) {
  expect_bits_of_one_process("through", {through, through});
}

/// Circles of a few elements and, around the box, of nearly all.
TEST(SweepsOnRanks, HaveTheBitsOfOneProcessInCircles) {
  const Stream vortices = [](const Vector<2>& x) { return through(x) + 2e-3 * noise(x); };
  expect_bits_of_one_process("vortices", {vortices, through, vortices});
  expect_bits_of_one_process("around", {around, through, around});
}

/// Round-off moves liquid that is at rest: circles everywhere.
TEST(SweepsOnRanks, HaveTheBitsOfOneProcessInStillWater) {
  const Stream still = [](const Vector<2>& x) { return 1e-18 * noise(x); };
  expect_bits_of_one_process("still", {still, through, still});
  expect_bits_of_one_process("nothing moves", {[](const Vector<2>&) { return 0.0; }});
}

}  // namespace sweeps_on_ranks_test
}  // namespace suffuse

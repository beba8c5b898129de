/// Liquid points under a given flow have the bits of one process on any number of ranks: places,
/// masses, numbers, fines on their way, and deposits in the soil. None is lost.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

#include "box_mesh.hpp"
#include "ordered_mesh.hpp"
#include "points/points_along_faces.hpp"
#include "ranks/mpi_ranks.hpp"
#include "solid/rigid_skeleton.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace points_on_ranks_test {

using model::Uniform;

constexpr LiquidDensities densities{1000.0, 2700.0};

/// A divergence-free velocity, which is linear in x, m/s.
template <int Dim>
struct LinearFlow {
  Vector<Dim> at_origin;
  Eigen::Matrix<double, Dim, Dim> gradient;

  [[nodiscard]] double through(const Grid<Dim>& grid, int face) const {
    return (at_origin + gradient * grid.face_centre(face)).dot(grid.face_normal[face]);
  }
};

/// Soil of two regions, of which both erode and one catches fines; all sides are open.
template <int Dim>
Case<Dim> whole_case(Mesh<Dim> mesh, int points_per_element) {
  Case<Dim> c;
  c.mesh = in_order(mesh);
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    c.mesh.element_region[e] = element_centroid(c.mesh, e)[0] < 0.5 ? 0 : 1;
  }
  c.mesh.region_names = {"specimen", "filter"};
  Scene& scene = c.document.scene;
  scene = model::paper_scene();
  scene.formulation = Formulation::double_point;
  Soil& soil = scene.soils[0];
  soil.erosion.law = erosion_law("constant");
  soil.erosion.rate = 1e-2;
  soil.erosion.critical_concentration = 0.05;
  Soil filter = soil;
  filter.region = "filter";
  filter.erosion.rate = 2e-3;
  filter.erosion.mass_transfer = MassTransfer::element;
  filter.deposition.coefficient = 2.0;
  filter.deposition.porosity_min = 0.25;
  scene.soils.push_back(filter);
  for (const BoundarySet<Dim>& set : c.mesh.boundaries) {
    BoundaryCondition open = model::pressure_on(set.name, 0.0);
    open.concentration = 0.02;
    scene.boundaries.push_back(open);
  }
  const Grid<Dim> grid(c.mesh);
  Uniform uniform(5);
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    for (int p = 0; p < points_per_element; ++p) {
      std::array<double, Dim + 1> at;
      double sum = 0.0;
      for (double& b : at) sum += b = 1.5 + uniform();
      for (double& b : at) b /= sum;
      // Some elements have no liquid, so that fines have to wait at nodes.
      for (MaterialPoints<Dim>* points : {&c.solid_points, &c.liquid_points}) {
        const bool is_liquid = points == &c.liquid_points;
        if (is_liquid && element_centroid(c.mesh, e).norm() < 0.4) continue;
        points->element.push_back(e);
        points->barycentric.push_back(at);
        points->volume.push_back((is_liquid ? 0.3 : 1.0) * grid.volume[e] / points_per_element);
      }
    }
  }
  return c;
}

template <int Dim>
InjectionSettings injection(const Grid<Dim>& grid, bool random) {
  InjectionSettings result;
  result.random = random;
  for (const int e : grid.face_left) {
    result.point_volume.push_back(0.3 * grid.volume[e] / 3.0);
    result.points_per_element.push_back(3);
  }
  return result;
}

/// Transport of points in a case or in a part of it.
template <int Dim>
struct Model {
  Model(Case<Dim> of, const std::optional<RankPart>& part, bool random)
      : c(std::move(of)),
        grid(part ? Grid<Dim>(c.mesh, *part) : Grid<Dim>(c.mesh)),
        soils(c),
        skeleton(grid, soils, TimeSpan{0.0, 1e9}, 1),
        conditions(face_conditions(c, grid)),
        pressure(c.mesh.elements.size(), 0.0),
        liquid(grid, skeleton, conditions, injection(grid, random), densities, 2e7, 1,
               c.liquid_points, pressure),
        exchange(skeleton, [this](PointFlows& flows) {
          flows.motion = LiquidMotion::passes;
          const std::vector<double> ahead = liquid.concentration_ahead(1.0);
          flows.concentration.clear();
          for (const int e : soils.points().element) flows.concentration.push_back(ahead[e]);
        }) {}

  /// Moves for `duration` seconds. Returns the number of points that crossed borders.
  std::size_t move(const LinearFlow<Dim>& field, double duration) {
    FlowProgress flow{1, duration, time + duration, {{}, {}}};
    for (int f = 0; f < grid.face_count(); ++f) {
      flow.volumes.liquid.push_back(duration * field.through(grid, f));
    }
    PointFlows flows;
    flows.start = time;
    flows.end = flow.end;
    exchange.start_interval(std::move(flows));
    const RegionCrossings& crossed = liquid.move(time, flow, pressure, exchange);
    time = flow.end;
    fines_out = crossed.fines_out;
    return crossed.points.size();
  }
  /// All numbers of the state, in the order of the whole model, on rank 0.
  [[nodiscard]] std::vector<double> of_all() const {
    std::vector<double> result;
    const auto add = [&](const std::vector<double>& own) {
      const std::vector<double> all = gather_values(grid.ranks(), own);
      result.insert(result.end(), all.begin(), all.end());
    };
    const LiquidPoints<Dim>& points = liquid.points();
    std::vector<double> places;
    std::vector<double> numbers;
    for (int p = 0; p < points.size(); ++p) {
      numbers.push_back(static_cast<double>(grid.element_number(points.element[p])));
      numbers.push_back(static_cast<double>(points.id[p]));
      places.insert(places.end(), points.barycentric[p].begin(), points.barycentric[p].end());
    }
    add(numbers);
    add(places);
    add(points.water_mass);
    add(points.fines_mass);
    std::vector<double> pores;
    for (const int p : soils.points_of(grid.own_elements()))
      pores.push_back(skeleton.porosity()[p]);
    add(pores);
    std::vector<double> waiting;
    for (const int i : grid.node_rows().own()) waiting.push_back(liquid.pending()[i]);
    add(waiting);
    std::vector<double> inflow;
    for (const int f : grid.own_faces()) inflow.push_back(liquid.inflow().volume[f]);
    add(inflow);
    result.insert(result.end(), fines_out.begin(), fines_out.end());
    result.push_back(liquid.empty_elements_total());
    return result;
  }

  Case<Dim> c;
  Grid<Dim> grid;
  SoilMap<Dim> soils;
  RigidSkeleton<Dim> skeleton;
  std::vector<FaceCondition> conditions;
  std::vector<double> pressure;
  PointsAlongFaces<Dim> liquid;
  SolidExchange<Dim> exchange;
  std::vector<double> fines_out;
  double time = 0.0;
};

template <int Dim>
RankPart part_of(const Case<Dim>& whole, Case<Dim>& here) {
  const auto ranks = mpi_ranks();
  LocalMesh<Dim> local = local_mesh(whole.mesh, ranks->rank(), ranks->count(), 2);
  RankPart part{ranks, local.numbers};
  here = local_case(whole, std::move(local));
  return part;
}

template <int Dim>
void expect_bits_of_one_process(const Case<Dim>& whole, const LinearFlow<Dim>& field, bool random) {
  Model<Dim> alone(whole, {}, random);
  Case<Dim> here;
  const RankPart part = part_of(whole, here);
  Model<Dim> shared(std::move(here), part, random);
  for (int interval = 0; interval < 6; ++interval) {
    alone.move(field, 1.0);
    shared.move(field, 1.0);
    const std::vector<double> found = shared.of_all();
    if (part.ranks->rank() != 0) continue;
    const std::vector<double> expected = alone.of_all();
    ASSERT_EQ(found.size(), expected.size()) << interval;
    std::size_t differ = 0;
    for (std::size_t i = 0; i < found.size(); ++i) differ += found[i] != expected[i] ? 1 : 0;
    EXPECT_EQ(differ, 0U) << interval;
  }
  if (part.ranks->rank() == 0) {
    EXPECT_GT(alone.liquid.inflow().next_id, 1.1 * static_cast<double>(whole.liquid_points.size()));
    EXPECT_GT(alone.liquid.empty_elements_total(), 0.0);
  }
}

Mesh<2> square(int cells) {
  return model::column_mesh(cells, cells, 1.0, 1.0, model::jittered(0.2 / cells, 2));
}

TEST(PointsOnRanks, HaveTheBitsOfOneProcess) {
  LinearFlow<2> plane{{0.02, 0.01}, Eigen::Matrix2d::Zero()};
  plane.gradient << 0.005, -0.03, 0.02, -0.005;
  for (const bool random : {false, true}) {
    expect_bits_of_one_process(whole_case(square(10), 3), plane, random);
  }
}

TEST(PointsOnRanks, HaveTheBitsOfOneProcessInSpace) {
  LinearFlow<3> space{{0.02, 0.01, -0.01}, Eigen::Matrix3d::Zero()};
  space.gradient << 0.005, -0.03, 0.01, 0.02, -0.003, 0.0, 0.01, 0.0, -0.002;
  expect_bits_of_one_process(whole_case(model::box_mesh({4, 4, 4}), 2), space, false);
}

/// Points that go around in a closed box cross from rank to rank, and all stay.
TEST(PointsOnRanks, LoseNone) {
  const auto ranks = mpi_ranks();
  if (ranks->count() != 3) GTEST_SKIP() << "on three ranks only";
  Case<2> whole = whole_case(square(6), 100);
  for (Soil& soil : whole.document.scene.soils) {
    soil.erosion = {};
    soil.deposition = {};
  }
  whole.document.scene.boundaries.clear();
  Case<2> here;
  const RankPart part = part_of(whole, here);
  Model<2> shared(std::move(here), part, false);
  // The stream function vanishes along the border.
  FlowProgress flow{1, 1.0, 0.0, {{}, {}}};
  const Grid<2>& grid = shared.grid;
  const auto stream = [](const Vector<2>& x) {
    return 0.05 * x[0] * (1.0 - x[0]) * x[1] * (1.0 - x[1]);
  };
  for (int f = 0; f < grid.face_count(); ++f) {
    const auto& [a, b] = grid.face_nodes[f];
    const Vector<2> along = grid.mesh.nodes[b] - grid.mesh.nodes[a];
    const double volume = stream(grid.mesh.nodes[b]) - stream(grid.mesh.nodes[a]);
    const double side = along[0] * grid.face_normal[f][1] - along[1] * grid.face_normal[f][0];
    flow.volumes.liquid.push_back(side > 0.0 ? volume : -volume);
  }
  const char* wanted = std::getenv("SUFFUSE_TEST_CROSSINGS");
  const double crossings = wanted != nullptr ? std::atof(wanted) : 2e5;
  const auto all = static_cast<std::size_t>(whole.liquid_points.size());
  double crossed = 0.0;
  const auto sorted_ids = [&] {
    std::vector<long> ids = shared.liquid.points().id;
    std::ranges::sort(ids);
    return ids;
  };
  std::vector<long> before = sorted_ids();
  long moves = 0;
  for (; crossed < crossings; ++moves) {
    flow.end = shared.time + 1.0;
    shared.exchange.start_interval({});
    shared.liquid.move(shared.time, flow, shared.pressure, shared.exchange);
    shared.time = flow.end;
    std::vector<long> now = sorted_ids();
    std::vector<long> come;
    std::ranges::set_difference(now, before, std::back_inserter(come));
    crossed += sum_of_all(*ranks, static_cast<double>(come.size()));
    before = std::move(now);
  }
  const std::vector<long> ids = gather_values(*ranks, shared.liquid.points().id);
  if (ranks->rank() != 0) return;
  EXPECT_EQ(ids.size(), all);
  EXPECT_EQ(std::set<long>(ids.begin(), ids.end()).size(), all);
  std::cout << all << " points crossed from rank to rank " << crossed << " times in " << moves
            << " intervals\n";
}

}  // namespace points_on_ranks_test
}  // namespace suffuse

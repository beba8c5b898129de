/// Walls that let liquid through, compared with resistances in series, a room that fills through
/// its wall, Gardner's profiles above a water table, and soil without a wall.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "boundary/leaky_walls.hpp"
#include "box_mesh.hpp"
#include "mesh/slit.hpp"
#include "model_run.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace leaky_wall_test {

constexpr double stiff = std::numeric_limits<double>::infinity();
constexpr double unit_weight = 9810.0;  ///< N/m3

Wall wall_on(const std::string& name, double conductance) {
  return {name, conductance};
}

/// A column one metre high of `ny` rows, cut along rows of nodes at shares of its height; regions
/// between the cuts are "soil 0", "soil 1", ... from below, the cuts "wall 0", ....
Mesh<2> walled_column(int ny, const std::vector<double>& cuts, double width = 0.25, int nx = 2) {
  Mesh<2> mesh = model::column_mesh(nx, ny, width, 1.0);
  mesh.region_names.clear();
  for (std::size_t r = 0; r <= cuts.size(); ++r) {
    mesh.region_names.push_back("soil " + std::to_string(r));
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double y = element_centroid(mesh, e)[1];
    mesh.element_region[e] =
        static_cast<int>(std::ranges::count_if(cuts, [&](double cut) { return y > cut; }));
  }
  std::vector<BoundarySet<2>> sets;
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    BoundarySet<2>& set =
        sets.emplace_back("wall " + std::to_string(c), decltype(BoundarySet<2>::faces){});
    const int first = static_cast<int>(std::lround(cuts[c] * ny)) * (nx + 1);
    for (int i = 0; i < nx; ++i) set.faces.push_back({first + i, first + i + 1});
  }
  EXPECT_TRUE(slit(mesh, sets).empty());
  return mesh;
}

/// Soils of these conductivities from bottom to top; water is not stored.
Scene column_scene(const std::vector<double>& conductivities) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.liquid.bulk_modulus = stiff;
  scene.initial_flow = InitialFlow::steady;
  const Soil soil = scene.soils[0];
  scene.soils.clear();
  for (std::size_t s = 0; s < conductivities.size(); ++s) {
    scene.soils.push_back(soil);
    scene.soils.back().region = "soil " + std::to_string(s);
    scene.soils.back().conductivity = conductivities[s];
  }
  scene.boundaries = {model::pressure_on("top", 5886.0), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].concentration = 0.0;
  scene.time.end = 10.0;
  return scene;
}

double flux_through(model::ModelRun& run) {
  return run.model().history_row(run.model().flow_state()).flux_in;
}

ElementValues<2> concentration_of(const FinesState<2>& state, int e) {
  ElementValues<2> result;
  for (int j = 0; j < 3; ++j) result[j] = state.fines_volume[e][j] / state.liquid_volume[e][j];
  return result;
}

TEST(LeakyWall, IsAResistanceInSeriesWithTheSoil) {
  const double width = 0.25;
  // In a centrifuge too: conductivity and conductance are those under the gravity of the earth.
  for (const double gravity : {0.0, -9.81, -98.1}) {
    for (const double conductance : {1e-14, 1e-9, 1e-6, 1e-4, 1e-2, 1.0}) {
      Scene scene = column_scene({2e-4, 3e-7});
      scene.gravity = {0.0, gravity, 0.0};
      scene.walls = {wall_on("wall 0", conductance)};
      // Storage of water does not change a steady flow.
      Scene stores = scene;
      stores.liquid.bulk_modulus = 2e9;
      model::ModelRun stored(model::make_case(walled_column(8, {0.375}, width), stores));
      model::ModelRun run(model::make_case(walled_column(8, {0.375}, width), scene));
      // Under gravity the water above stands one metre higher.
      const double head = 0.6 - gravity / 9.81;
      const double exact = width * head / (0.375 / 2e-4 + 1.0 / conductance + 0.625 / 3e-7);
      EXPECT_NEAR(flux_through(run) / exact, 1.0, 1e-10) << conductance << ' ' << gravity;
      EXPECT_NEAR(flux_through(stored) / exact, 1.0, 1e-10);
      const HistoryRow row = run.model().history_row(run.model().flow_state());
      EXPECT_NEAR(row.flux_out / exact, 1.0, 1e-10);
      run.run({10.0});
      EXPECT_NEAR(flux_through(run) / exact, 1.0, 1e-10);
      EXPECT_LE(run.worst_residual(), 1e-12);
      const auto boundaries = run.model().boundary_rows(run.model().flow_state());
      ASSERT_EQ(boundaries.size(), 3U);
      EXPECT_EQ(boundaries[2].boundary, "wall 0");
      for (const double through : {boundaries[2].liquid_in, boundaries[2].liquid_out}) {
        EXPECT_NEAR(through / (10.0 * exact), 1.0, 1e-10);
      }
      EXPECT_NEAR(boundaries[2].water_out / boundaries[1].water_out, 1.0, 1e-10);
    }
  }
}

TEST(LeakyWall, HidesNoDigitOfTheFlux) {
  // A wall with a much larger conductance than the soil, deep under water, solved in one step.
  const double conductance = 3e4;
  model::FlowModel m(walled_column(8, {0.375}, 0.3, 5));
  m.set_conductivity([](const Vector<2>& x) { return x[1] > 0.375 ? 3e-4 : 7e-4; });
  m.set("top", FaceKind::pressure, 1e5 + 30000.0);
  m.set("bottom", FaceKind::pressure, 1e5);
  Scene scene;
  scene.liquid.density = 1000.0;
  scene.walls = {wall_on("wall 0", conductance)};
  const std::vector<LeakyFace> walls = leaky_faces(model::make_case(m.mesh, scene), m.grid);
  for (const LeakyFace& wall : walls) m.grid.join_faces({{wall.face, wall.partner}});
  ImplicitMixed<2> flow(m.grid, {}, Vector<2>::Zero(), {}, walls);
  const MixedStep<2> steady = flow.steady(m.forcing);
  double flux = 0.0;
  for (int f = 0; f < m.grid.face_count(); ++f) {
    if (m.grid.is_border(f)) flux += std::max(0.0, steady.face_flux[f]);
  }
  const double resistance = 0.375 / 7e-4 + 1.0 / conductance + 0.625 / 3e-4;
  EXPECT_NEAR(flux / (0.3 * 30000.0 / unit_weight / resistance), 1.0, 1e-12);
}

TEST(LeakyWall, AsGoodAsNoneTakesNoMoreStepsNearRest) {
  // A level that rises from rest along clay with a seam; its face above the level is dry.
  const auto steps = [](double conductance) {
    Scene scene = column_scene({1e-7, 1e-7});
    scene.gravity = {0.0, -9.81, 0.0};
    scene.initial_flow = InitialFlow::rest;
    scene.water_level = 0.2;
    scene.liquid.bulk_modulus = 2e9;
    scene.boundaries.resize(1);
    scene.boundaries[0] = {};
    scene.boundaries[0].on = "left";
    scene.boundaries[0].head = TimeFunction({{0.0, 0.2}, {1e6, 0.8}});
    scene.walls = {wall_on("wall 0", conductance)};
    scene.time.end = 1e7;
    model::ModelRun run(model::make_case(walled_column(20, {0.5}, 2.0, 20), scene));
    while (run.model().time() < 1e7 && run.steps() < 1000) run.model().advance(1e7);
    return run.steps();
  };
  const long loose = steps(1e-6);
  EXPECT_LT(loose, 150);
  EXPECT_LT(steps(1.0), 1.2 * static_cast<double>(loose));
}

TEST(LeakyWall, HasOneConcentrationWhateverFlows) {
  const Mesh<2> mesh = walled_column(4, {0.5});
  Scene scene = column_scene({1e-3, 1e-3});
  scene.walls = {wall_on("wall 0", 1e-3)};
  const Case<2> c = model::make_case(mesh, scene);
  const Grid<2> grid = grid_with_walls(c);
  const std::vector<FaceCondition> conditions = face_conditions(c, grid);
  const ElementSides<2> sides(grid);
  const EulerianTransport<2> transport(grid, sides, conditions);
  FinesState<2> state;
  for (int e = 0; e < mesh.element_count(); ++e) {
    state.liquid_volume.push_back({1e-3, 1e-3, 1e-3});
    state.fines_volume.push_back({1e-6 * e, 2e-6 * e, 4e-6 * e});
  }
  for (const double volume : {-1e-6, 0.0, 1e-6}) {
    std::vector<double> volumes(grid.face_count(), 0.0);
    for (int f = 0; f < grid.face_count(); ++f) {
      if (grid.face_partner[f] > f) volumes[f] = -(volumes[grid.face_partner[f]] = volume);
    }
    const std::vector<double> concentration = transport.face_concentration(state, volumes);
    for (int f = 0; f < grid.face_count(); ++f) {
      const int partner = grid.face_partner[f];
      if (partner < 0) continue;
      EXPECT_EQ(concentration[f], concentration[partner]);
      // The concentration is that of the side from which liquid comes.
      const int from = volumes[f] >= 0.0 ? f : partner;
      if (volume == 0.0) continue;
      const auto at_vertices =
          FieldNodes<2>::at_vertices(concentration_of(state, grid.face_left[from]));
      const int k = grid.side_of(grid.face_left[from], from);
      EXPECT_NEAR(concentration[f], 0.5 * (at_vertices[(k + 1) % 3] + at_vertices[(k + 2) % 3]),
                  1e-15);
    }
  }
}

TEST(LeakyWall, IsOneInThreeDimensionsToo) {
  Mesh<3> mesh = model::box_mesh({3, 2, 4}, {0.75, 0.5, 1.0});
  mesh.region_names = {"soil 0", "soil 1"};
  BoundarySet<3> cut{"wall 0", {}};
  const Grid<3> whole(mesh);
  for (int f = 0; f < whole.face_count(); ++f) {
    if (std::abs(whole.face_centre(f)[2] - 0.5) < 1e-9) cut.faces.push_back(whole.face_nodes[f]);
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = element_centroid(mesh, e)[2] > 0.5 ? 1 : 0;
  }
  EXPECT_TRUE(slit(mesh, {cut}).empty());
  Scene scene = column_scene({1e-3, 2e-4});
  scene.liquid.bulk_modulus = 2e7;
  scene.boundaries[0].concentration = 0.05;
  scene.walls = {wall_on("wall 0", 1e-4)};
  scene.soils[1].erosion = {erosion_law("first-order"), 1e-3, 0.0, false};
  scene.time.end = 1000.0;
  const Case<3> c = model::make_case(mesh, scene);
  SinglePoint<3> run(c, make_plan(c, {}));
  const double exact = 0.75 * 0.5 * 0.6 / (0.5 / 1e-3 + 1.0 / 1e-4 + 0.5 / 2e-4);
  EXPECT_NEAR(run.history_row(run.flow_state()).flux_out / exact, 1.0, 1e-10);
  while (run.time() < 1000.0) {
    run.advance(1000.0);
    for (const RegionRow& row : run.region_rows()) {
      EXPECT_LE(std::abs(row.ledger.residual_water), 1e-12);
      EXPECT_LE(std::abs(row.ledger.residual_grains), 1e-12);
    }
    EXPECT_LE(std::abs(run.ledger().residual_grains), 1e-12);
  }
  EXPECT_GT(run.region_rows()[0].ledger.fines_in, 0.0);
}

TEST(LeakyWall, ClosesNoRoomOfWaterThatIsNotStored) {
  // The room between two walls has no other outlet; the one below the last wall has only this wall.
  for (const double conductance : {1e-9, 1e-6, 1e-3}) {
    Scene scene = column_scene({1e-3, 1e-3, 1e-3});
    scene.walls = {wall_on("wall 0", conductance), wall_on("wall 1", 2.0 * conductance)};
    {
      model::ModelRun run(model::make_case(walled_column(8, {0.25, 0.75}), scene));
      const double exact = 0.25 * 0.6 / (1.0 / 1e-3 + 1.5 / conductance);
      EXPECT_NEAR(flux_through(run) / exact, 1.0, 1e-10) << conductance;
    }
    scene.boundaries.pop_back();
    scene.gravity = {0.0, -9.81, 0.0};
    model::ModelRun run(model::make_case(walled_column(8, {0.25, 0.75}), scene));
    run.run({10.0});
    EXPECT_LE(flux_through(run), 1e-10 * 0.25 * conductance);
    const FlowState<2> flow = run.model().flow_state();
    for (int i = 0; i < run.input().mesh.node_count(); ++i) {
      const double rest = 5886.0 + unit_weight * (1.0 - run.input().mesh.nodes[i][1]);
      EXPECT_NEAR(flow.node_pressure[i], rest, 1e-8 * rest);
    }
  }
}

TEST(LeakyWall, FillsARoomAtTheRateOfItsStorage) {
  // Soil is so permeable that pressure is uniform in each room: dp/dt = C / (S w) (p_above - p).
  const double conductance = 1e-6;
  Scene scene = column_scene({1e-2, 1e-2});
  scene.liquid.bulk_modulus = 2e7;
  scene.initial_flow = InitialFlow::rest;
  scene.walls = {wall_on("wall 0", conductance)};
  scene.boundaries.pop_back();
  const double storage = 0.5 * 0.3 / 2e7;  // m/Pa
  const double time_constant = storage * unit_weight / conductance;
  scene.time.end = 3.0 * time_constant;
  scene.time.tolerance = 1e-5;
  scene.time.inertia = false;
  model::ModelRun run(model::make_case(walled_column(8, {0.5}), scene));
  for (const double share : {0.3, 1.0, 3.0}) {
    const auto moments = run.run({share * time_constant});
    const double exact = 5886.0 * (1.0 - std::exp(-share));
    EXPECT_NEAR(moments.flows.back().node_pressure[0] / exact, 1.0, 1e-4) << share;
  }
  EXPECT_LE(run.worst_residual(), 1e-12);
}

TEST(LeakyWall, LetsFinesPassAsIfItWereNotThere) {
  // A prescribed flux causes the same volumes with and without a wall.
  Scene scene = column_scene({1e-3, 1e-3});
  scene.boundaries[0] = model::flux_on("top", 1e-2);
  scene.boundaries[0].concentration = 0.1;
  scene.time.end = 40.0;
  scene.soils[0].erosion = scene.soils[1].erosion = {erosion_law("first-order"), 5e-3, 5.0, false};
  for (const double modulus : {stiff, 2e7}) {
    scene.liquid.bulk_modulus = modulus;
    Scene with_wall = scene;
    // Compressed water has another volume, so the wall has only a small jump of pressure then.
    with_wall.walls = {wall_on("wall 0", std::isinf(modulus) ? 1e-4 : 1.0)};
    model::ModelRun run(model::make_case(walled_column(8, {0.5}), with_wall));
    Mesh<2> whole = model::column_mesh(2, 8, 0.25, 1.0);
    whole.region_names = {"soil 0", "soil 1"};
    whole.element_region = run.input().mesh.element_region;
    model::ModelRun free_run(model::make_case(whole, scene));
    const auto a = run.run({10.0, 20.0, 40.0});
    const auto b = free_run.run({10.0, 20.0, 40.0});
    double crossed = 0.0;
    for (std::size_t i = 0; i < a.states.size(); ++i) {
      const auto& fines = a.states[i].liquid.fines_volume;
      for (std::size_t e = 0; e < fines.size(); ++e) {
        for (int j = 0; j < 3; ++j) {
          const double other = b.states[i].liquid.fines_volume[e][j];
          EXPECT_NEAR(fines[e][j], other, std::isinf(modulus) ? 1e-15 : 1e-8);
        }
      }
      crossed = a.states[i].regions[1].ledger.fines_out;
      EXPECT_GT(crossed, 0.0);
      EXPECT_EQ(a.states[i].regions[0].ledger.fines_in, crossed) << "what leaves by one side";
      EXPECT_NEAR(a.states[i].ledger.fines_out / b.states[i].ledger.fines_out, 1.0,
                  std::isinf(modulus) ? 1e-12 : 1e-4);
    }
    EXPECT_LE(run.worst_residual(), 1e-12);
    for (const RegionRow& row : run.model().region_rows()) {
      EXPECT_LE(std::abs(row.ledger.residual_water), 1e-12);
      EXPECT_LE(std::abs(row.ledger.residual_grains), 1e-12);
    }
    const auto boundaries = run.model().boundary_rows(run.model().flow_state());
    EXPECT_NEAR(boundaries[2].fines_out / crossed, 1.0, 1e-12);
    EXPECT_NEAR(boundaries[2].fines_in / crossed, 1.0, 1e-12);
  }
}

TEST(LeakyWall, UniformConcentrationStaysUniform) {
  // After forty pore volumes the initial water is gone; then the concentration is that of the
  // inflow everywhere.
  Scene scene = column_scene({1e-3, 1e-3});
  scene.boundaries[0].concentration = 0.1;
  scene.walls = {wall_on("wall 0", 1e-2)};
  scene.time.end = 20000.0;
  model::ModelRun run(model::make_case(walled_column(8, {0.5}), scene));
  const HistoryRow row = run.run({20000.0}).states.back().history;
  EXPECT_NEAR(row.concentration_min, 0.1, 1e-11);
  EXPECT_NEAR(row.concentration_max, 0.1, 1e-11);
  EXPECT_LE(run.worst_residual(), 1e-12);
}

/// Soil one metre wide and high under a sheet pile from its surface to half its depth: flow from
/// the left half of the surface to the right half.
model::ModelRun sheet_pile(double conductance, bool cut = true) {
  Mesh<2> mesh = model::column_mesh(8, 8);
  mesh.region_names = {"soil 0"};
  BoundarySet<2> left{"surface left", {}};
  BoundarySet<2> right{"surface right", {}};
  for (int i = 0; i < 8; ++i) (i < 4 ? left : right).faces.push_back({72 + i, 73 + i});
  mesh.boundaries = {left, right};
  BoundarySet<2> pile{"pile", {}};
  for (int j = 4; j < 8; ++j) pile.faces.push_back({9 * j + 4, 9 * (j + 1) + 4});
  if (cut) slit(mesh, {pile});
  Scene scene = column_scene({1e-4});
  scene.boundaries = {model::pressure_on("surface left", 9810.0),
                      model::pressure_on("surface right", 0.0)};
  scene.boundaries[0].concentration = 0.0;
  if (cut) scene.walls = {wall_on("pile", conductance)};
  return model::ModelRun(model::make_case(mesh, scene));
}

TEST(LeakyWall, IsBetweenNoWallAndAnImperviousOne) {
  auto closed = sheet_pile(0.0);
  auto open = sheet_pile(0.0, false);
  const double least = flux_through(closed);
  const double most = flux_through(open);
  EXPECT_GT(most, 1.2 * least);
  double last = least;
  for (const double conductance : {1e-12, 1e-6, 1e-4, 1e-2}) {
    auto run = sheet_pile(conductance);
    EXPECT_GT(flux_through(run), last) << conductance;
    last = flux_through(run);
    EXPECT_LT(last, most);
  }
  auto tight = sheet_pile(1e-14);
  EXPECT_NEAR(flux_through(tight) / least, 1.0, 1e-9);
  for (const double conductance : {1e6, 1e300}) {
    auto leaky = sheet_pile(conductance);
    EXPECT_NEAR(flux_through(leaky) / most, 1.0, 1e-5) << conductance;
  }
}

TEST(LeakyWall, TakesTheJumpOfGardnersProfile) {
  // Steady infiltration q above a water table: u = q/K + (u_0 - q/K) exp(-alpha z), u = exp(alpha
  // psi), from psi = 0 at the table and from psi + q/C right above the wall.
  const double conductivity = 1e-5;
  const double alpha = 2.0;
  const double flux = 2e-6;
  const double conductance = 1e-5;  // a jump of 0.2 m
  const double share = flux / conductivity;
  const auto u_at = [&](double z) {
    const double below = share + (1.0 - share) * std::exp(-alpha * std::min(z, 0.5));
    if (z <= 0.5) return below;
    const double above = below * std::exp(alpha * flux / conductance);
    return share + (above - share) * std::exp(-alpha * (z - 0.5));
  };
  double coarse = 0.0;
  for (const int rows : {16, 32}) {
    Scene scene = column_scene({conductivity, conductivity});
    scene.gravity = {0.0, -9.81, 0.0};
    scene.time.stepping = TimeStepping::monotone;
    for (Soil& soil : scene.soils) soil.retention = model::gardner(alpha);
    scene.boundaries[0] = model::flux_on("top", flux);
    scene.boundaries[1].concentration = 0.0;
    scene.walls = {wall_on("wall 0", conductance)};
    scene.time.end = 86400.0;
    model::ModelRun run(model::make_case(walled_column(rows, {0.5}, 1.0 / rows, 1), scene));
    const auto moments = run.run({86400.0});
    const FlowState<2>& flow = moments.flows.back();
    // The faces at the wall have its jump on any mesh.
    const Grid<2> grid = grid_with_walls(run.input());
    double error = 0.0;
    int pairs = 0;
    for (int f = 0; f < grid.face_count(); ++f) {
      const double z = grid.face_centre(f)[1];
      const int partner = grid.face_partner[f];
      const double psi = flow.face_pressure[f] / unit_weight;
      if (partner < 0) {
        error = std::max(error, std::abs(psi - std::log(u_at(z)) / alpha));
      } else if (grid.mesh.element_region[grid.face_left[f]] == 1) {
        ++pairs;
        EXPECT_NEAR(psi - flow.face_pressure[partner] / unit_weight, flux / conductance, 1e-5);
        EXPECT_EQ(flow.face_flux[f], -flow.face_flux[partner]);
      }
    }
    EXPECT_EQ(pairs, 1);
    EXPECT_LE(run.worst_residual(), 1e-12);
    if (rows == 32) {
      EXPECT_LT(error, 0.35 * coarse) << "of second order";
      EXPECT_LT(error, 1e-3);
    }
    coarse = error;
  }
}

TEST(LeakyWall, WetsDrySoilBehindIt) {
  // A pond on a thin layer over a clogged sheet: the conductance of the sheet limits the inflow.
  const double conductance = 2e-7;
  Scene scene = column_scene({1e-5, 1e-5});
  scene.gravity = {0.0, -9.81, 0.0};
  scene.time.stepping = TimeStepping::monotone;
  scene.initial_flow = InitialFlow::rest;
  scene.water_level = -1.0;
  for (Soil& soil : scene.soils) soil.retention = model::van_genuchten(2.0, 1.8);
  scene.boundaries = {model::pressure_on("top", 981.0)};
  scene.boundaries[0].concentration = 0.05;
  scene.walls = {wall_on("wall 0", conductance)};
  scene.time.end = 40000.0;
  const double width = 1.0 / 16;
  model::ModelRun run(model::make_case(walled_column(16, {0.75}, width, 1), scene));
  const double water = run.model().ledger().water;
  double last = 0.0;
  for (const double time : {10000.0, 20000.0, 40000.0}) {
    run.run({time});
    const auto rows = run.model().boundary_rows(run.model().flow_state());
    // The pond level is 0.35 m above the sheet, and the suction below the sheet is 1 to 2 m.
    const double passed = rows[1].liquid_in - last;
    last = rows[1].liquid_in;
    const double duration = time == 40000.0 ? 20000.0 : 10000.0;
    EXPECT_LT(passed, width * duration * conductance * (0.35 + 1.75)) << time;
    EXPECT_GT(passed, width * duration * conductance * 0.35) << time;
  }
  EXPECT_GT(run.model().ledger().water, water);
  EXPECT_LE(run.worst_residual(), 1e-12);
  for (const RegionRow& row : run.model().region_rows()) {
    EXPECT_LE(std::abs(row.ledger.residual_water), 1e-12);
    EXPECT_LE(std::abs(row.ledger.residual_grains), 1e-12);
  }
  // Above the sheet soil is saturated and almost at rest, while soil below it is under suction.
  const FlowState<2> flow = run.model().flow_state();
  for (int e = 0; e < run.input().mesh.element_count(); ++e) {
    const bool above = run.input().mesh.element_region[e] == 1;
    EXPECT_EQ(flow.pressure[e] > 0.0, above);
  }
}

TEST(LeakyWall, StandsInFastFlow) {
  // Ergun's law in series with the wall: dp = L (a q + b q^2) + rho_w g q / C.
  Scene scene = column_scene({2e-2, 2e-2});
  for (Soil& soil : scene.soils) soil.drag = SoilDrag::ergun;
  const double conductance = 5e-2;
  scene.walls = {wall_on("wall 0", conductance)};
  model::ModelRun run(model::make_case(walled_column(8, {0.5}), scene));
  const double n = scene.soils[0].porosity;
  const double size = ergun_grain_size(2e-2, n, 1000.0, 1e-3);
  const double a = unit_weight / 2e-2 + unit_weight / conductance;
  const double b = ergun_quadratic_drag(n, 1000.0, size);
  const double exact = (std::sqrt(a * a + 4.0 * b * 5886.0) - a) / (2.0 * b);
  EXPECT_LT(exact, 0.99 * 5886.0 / a) << "the quadratic drag counts";
  EXPECT_NEAR(flux_through(run) / (0.25 * exact), 1.0, 1e-10);
}

TEST(LeakyWall, OneAndTwoThreadsGiveTheSameBitsAndARestoredRunToo) {
  Scene scene = column_scene({1e-3, 1e-4});
  scene.liquid.bulk_modulus = 2e7;
  scene.initial_flow = InitialFlow::rest;
  scene.walls = {wall_on("wall 0", 1e-4)};
  scene.boundaries[0].concentration = 0.02;
  scene.time.step = 0.5;
  scene.time.end = 2.0;
  for (Soil& soil : scene.soils) {
    soil.erosion = {erosion_law("flux"), 2.0, 0.0, false};
    soil.conductivity_law = conductivity_law("kozeny-carman");
  }
  const Mesh<2> mesh = walled_column(64, {0.5}, 1.0, 64);
  const auto started = [&](int threads) {
    SolverOptions options;
    options.threads = threads;
    return model::ModelRun(model::make_case(mesh, scene), options);
  };
  auto one = started(1);
  auto two = started(2);
  one.run({1.0, 2.0});
  two.run({1.0});
  StateArchive kept;
  two.model().archive(kept);
  auto resumed = started(2);
  StateArchive given(kept.finish());
  resumed.model().archive(given);
  resumed.run({2.0});
  const auto bits = [](model::ModelRun& run) {
    return run.model().snapshot(run.model().flow_state());
  };
  const Snapshot a = bits(one);
  const Snapshot b = bits(resumed);
  for (const auto& [x, y] :
       {std::pair{&a.cell, &b.cell}, std::pair{&a.node, &b.node}, std::pair{&a.solid, &b.solid}}) {
    for (std::size_t k = 0; k < x->size(); ++k) EXPECT_EQ((*x)[k].values, (*y)[k].values);
  }
  EXPECT_GT(one.model().ledger().fines_out, 0.0);
}

}  // namespace leaky_wall_test
}  // namespace suffuse

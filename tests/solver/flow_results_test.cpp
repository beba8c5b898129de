/// Results of boundaries, probes and sections, against known fields and fluxes.

#include <gtest/gtest.h>

#include <limits>

#include "boundary/face_conditions.hpp"
#include "common/errors.hpp"
#include "formulation/masses.hpp"
#include "formulation/observations.hpp"
#include "results/state_archive.hpp"
#include "verification/moving_soil.hpp"

namespace suffuse {
namespace flow_results_test {

using model::column_mesh;
using model::jittered;

/// Fluxes of the stream function with these values at nodes: the flux across a line to its right is
/// the stream function at its end minus that at its start.
std::vector<double> fluxes_of(const Grid<2>& grid, const std::vector<double>& stream) {
  std::vector<double> flux;
  for (int f = 0; f < grid.face_count(); ++f) {
    const auto [a, b] = grid.face_nodes[f];
    const Vector<2> way = grid.mesh.nodes[b] - grid.mesh.nodes[a];
    const bool rightward = grid.face_normal[f].dot(Vector<2>(way[1], -way[0])) > 0.0;
    flux.push_back((rightward ? 1.0 : -1.0) * (stream[b] - stream[a]));
  }
  return flux;
}

double value_at(const Grid<2>& grid, const std::vector<double>& at_nodes, const Vector<2>& x) {
  return interpolate(grid, find_place(grid, x).value(), at_nodes);
}

class Sections : public testing::Test {
 protected:
  Sections() {
    std::mt19937_64 random(7);
    for (int i = 0; i < mesh_.node_count(); ++i) {
      stream_.push_back(static_cast<double>(random() >> 11) * 0x1p-53);
    }
  }
  /// Checks both directions along the line.
  void expect_exact(const Vector<2>& from, const Vector<2>& to) const {
    const std::vector<double> flux = fluxes_of(grid_, stream_);
    const double exact = value_at(grid_, stream_, to) - value_at(grid_, stream_, from);
    EXPECT_NEAR(SectionLine(grid_, from, to).across(flux).value(), exact, 1e-12);
    EXPECT_NEAR(SectionLine(grid_, to, from).across(flux).value(), -exact, 1e-12);
    EXPECT_NEAR(SectionLine(grid_, from, to).length(), (to - from).norm(), 1e-12);
  }

  Mesh<2> mesh_ = column_mesh(9, 7, 1.0, 1.0, jittered(0.03, 3));
  Grid<2> grid_{mesh_};
  std::vector<double> stream_;
};

TEST_F(Sections, AnywhereInTheMesh) {
  expect_exact({0.0, 0.13}, {1.0, 0.71});
  expect_exact({0.21, 0.9}, {0.23, 0.04});
  expect_exact({0.5, 0.5}, {0.5, 0.51});
}

TEST_F(Sections, OnNodesAndAlongFaces) {
  const auto& nodes = mesh_.nodes;
  // From node to node, along single faces inside and on the outer boundary.
  expect_exact(nodes[23], nodes[56]);
  for (int f = 0; f < grid_.face_count(); ++f) {
    expect_exact(nodes[grid_.face_nodes[f][0]], nodes[grid_.face_nodes[f][1]]);
  }
  expect_exact({0.0, 0.0}, {1.0, 0.0});
  expect_exact({1.0, 1.0}, {1.0, 0.0});
}

TEST_F(Sections, AlongManyFacesOfAnEvenMesh) {
  const Mesh<2> mesh = column_mesh(9, 7);
  const Grid<2> grid(mesh);
  const std::vector<double> flux = fluxes_of(grid, stream_);
  for (int j = 0; j <= 7; ++j) {
    const SectionLine line(grid, {0.0, j / 7.0}, {1.0, j / 7.0});
    EXPECT_NEAR(line.across(flux).value(), stream_[10 * j + 9] - stream_[10 * j], 1e-12) << j;
    EXPECT_NEAR(line.length(), 1.0, 1e-12);
  }
  // Along the diagonals of seven cells.
  const SectionLine diagonal(grid, {0.0, 0.0}, {7.0 / 9.0, 1.0});
  EXPECT_NEAR(diagonal.across(flux).value(), stream_[77] - stream_[0], 1e-12);
}

TEST_F(Sections, PartsOutsideCountNothing) {
  const std::vector<double> flux = fluxes_of(grid_, stream_);
  const SectionLine inside(grid_, {0.0, 0.25}, {1.0, 0.5});
  const SectionLine beyond(grid_, {-1.0, 0.0}, {3.0, 1.0});
  EXPECT_NEAR(beyond.across(flux).value(), inside.across(flux).value(), 1e-12);
  EXPECT_NEAR(beyond.length(), inside.length(), 1e-12);
  EXPECT_EQ(SectionLine(grid_, {2.0, 0.0}, {2.0, 1.0}).length(), 0.0);
}

TEST_F(Sections, ThatLeaveTheMeshAtANodeEndThere) {
  // Mesh generators put nodes slightly off their places: faces are then almost along the line.
  const auto move = [](const Vector<2>& x) {
    return x[1] == 0.0 ? Vector<2>(x[0] + 6.6e-11, 0.0) : x;
  };
  const Mesh<2> mesh = column_mesh(9, 7, 1.0, 1.0, move);
  const Grid<2> grid(mesh);
  const std::vector<double> flux = fluxes_of(grid, stream_);
  const SectionLine line(grid, {4.0 / 9.0, -1.0}, {4.0 / 9.0, 2.0});
  EXPECT_NEAR(line.length(), 1.0, 1e-14);
  // The foot of the line is 6.6e-11 m, in cells of 1/9 m, to the left of the node.
  const double foot = stream_[4] + 9.0 * 6.6e-11 * (stream_[3] - stream_[4]);
  EXPECT_NEAR(line.across(flux).value(), stream_[7 * 10 + 4] - foot, 1e-14);
}

TEST_F(Sections, OfLiquidThatSpreads) {
  // q = x has the divergence 2 and is in the space of Raviart and Thomas.
  std::vector<double> flux;
  for (int f = 0; f < grid_.face_count(); ++f) {
    flux.push_back(grid_.face_normal[f].dot(grid_.face_centre(f)));
  }
  const Vector<2> from(0.1, 0.2);
  const Vector<2> to(0.9, 0.5);
  const double exact = from[0] * (to - from)[1] - from[1] * (to - from)[0];
  EXPECT_NEAR(SectionLine(grid_, from, to).across(flux).value(), exact, 1e-12);
}

OutputSection section(double x0, double y0, double x1, double y1) {
  return {{x0, y0, 0.0}, {x1, y1, 0.0}};
}

/// A conduit of porous soil, full of water, steady from the start: in above, out below.
Scene conduit_scene() {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.step = 0.25;
  scene.time.end = 1.0;
  scene.initial_flow = InitialFlow::steady;
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  return scene;
}

TEST(Discharge, OfSectionsAcrossAConduitIsThatOfItsEnds) {
  Scene scene = conduit_scene();
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  // Sections: inclined, along faces, from node to node, and from right to left.
  scene.output.sections = {section(0.0, 0.3, 1.0, 0.77), section(0.0, 0.5, 1.0, 0.5),
                           section(0.0, 0.25, 1.0, 1.0), section(1.0, 0.6, 0.0, 0.61)};
  // Nodes at half the height are not displaced, so that faces lie on that line.
  auto move = jittered(0.02, 11);
  const auto move_most = [&](const Vector<2>& x) {
    const Vector<2> moved = move(x);
    return x[1] == 0.5 ? x : moved;
  };
  model::ModelRun run(model::make_case(column_mesh(8, 8, 1.0, 1.0, move_most), scene));
  const auto moments = run.run({0.5, 1.0});
  const FlowState<2>& flow = moments.flows.back();
  const std::vector<BoundaryRow> ends = run.model().boundary_rows(flow);
  const std::vector<SectionRow> rows = run.model().section_rows(flow);
  ASSERT_EQ(rows.size(), 4U);
  const double out = ends[1].discharge;
  EXPECT_NEAR(out, 2e-2 * 6000.0 / (1000.0 * 9.81), 1e-3 * out);
  EXPECT_NEAR(ends[0].discharge, -out, 1e-12 * out);
  for (int k = 0; k < 4; ++k) {
    // Downward flow crosses a line to its right if it goes from left to right.
    const double sign = k == 3 ? -1.0 : 1.0;
    EXPECT_EQ(rows[k].section, k);
    EXPECT_NEAR(rows[k].discharge, sign * out, 1e-12 * out) << k;
    EXPECT_NEAR(rows[k].volume, sign * ends[1].liquid_out, 1e-12 * ends[1].liquid_out) << k;
  }
  EXPECT_NEAR(ends[1].liquid_out, out, 1e-12 * out) << "after one second";
  EXPECT_NEAR(ends[0].liquid_in, out, 1e-12 * out);
  EXPECT_EQ(ends[0].liquid_out, 0.0);
}

/// A field that is linear in space: inclined gravity, boundaries with the pressure of a uniform
/// flow.
class Probes : public testing::Test {
 protected:
  static constexpr double g = 9.81;
  static constexpr double angle = 0.3;

  Probes() {
    scene_.gravity = {g * std::sin(angle), -g * std::cos(angle), 0.0};
    scene_.soils[0].porosity = 0.25;
    scene_.soils[0].porosity_gradient = {0.05, 0.02, 0.0};
    // Uniform flow along the conduit, against gravity.
    scene_.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 9000.0)};
    scene_.output.probes = {{{0.31, 0.77, 0.0}}, {{0.5, 0.5, 0.0}}, {{1.0, 0.0, 0.0}}};
  }

  Scene scene_ = conduit_scene();
};

TEST_F(Probes, HaveTheLinearStateOfAUniformFlow) {
  scene_.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene_.gravity = {0.0, -g, 0.0};
  model::ModelRun run(model::make_case(column_mesh(6, 5, 1.0, 1.0, jittered(0.03, 5)), scene_));
  const FlowState<2> flow = run.run({1.0}).flows.front();
  const std::vector<ProbeRow> rows = run.model().probe_rows(flow);
  ASSERT_EQ(rows.size(), 3U);
  const double gradient = (6000.0 - 9000.0) / (1000.0 * g) + 1.0;  // of head, upwards
  for (int k = 0; k < 3; ++k) {
    const ProbeRow& row = rows[k];
    const auto& [x, y, z] = scene_.output.probes[k].at;
    EXPECT_EQ(row.t, 1.0);
    EXPECT_EQ(row.probe, k);
    EXPECT_EQ(row.x, x);
    EXPECT_EQ(row.y, y);
    EXPECT_NEAR(row.pressure, 9000.0 - 3000.0 * y, 1e-6);
    EXPECT_NEAR(row.head, 9000.0 / (1000.0 * g) + gradient * y, 1e-9);
    EXPECT_NEAR(row.flux_x, 0.0, 1e-9);
    EXPECT_NEAR(row.flux_y, -2e-2 * gradient, 1e-9);
    EXPECT_NEAR(row.porosity, 0.25 + 0.05 * x + 0.02 * y, 1e-12);
    EXPECT_EQ(row.concentration, 0.0);
    EXPECT_EQ(row.saturation, 1.0);
  }
}

TEST_F(Probes, HeadIsTheSameEverywhereInWaterAtRest) {
  // There are walls all around except at a corner of the bottom, with the pressure of a head of 2
  // m.
  scene_.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene_.boundaries.clear();
  Mesh<2> mesh = column_mesh(6, 5);
  mesh.boundaries.push_back({"corner", {mesh.boundaries[1].faces.front()}});
  mesh.boundaries[1].faces.erase(mesh.boundaries[1].faces.begin());
  const Vector<2> middle(1.0 / 12.0, 0.0);
  const double z = -middle[0] * std::sin(angle);
  scene_.boundaries = {model::pressure_on("corner", 1000.0 * g * (2.0 - z))};
  model::ModelRun run(model::make_case(mesh, scene_));
  for (const ProbeRow& row : run.model().probe_rows(run.run({1.0}).flows.front())) {
    EXPECT_NEAR(row.head, 2.0, 1e-9) << row.probe;
    const double height = -row.x * std::sin(angle) + row.y * std::cos(angle);
    EXPECT_NEAR(row.pressure, 1000.0 * g * (2.0 - height), 1e-5);
  }
}

TEST_F(Probes, WithoutGravityHeadIsPressureOverWeight) {
  scene_.gravity = {};
  scene_.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  model::ModelRun run(model::make_case(column_mesh(6, 5), scene_));
  for (const ProbeRow& row : run.model().probe_rows(run.run({1.0}).flows.front())) {
    EXPECT_DOUBLE_EQ(row.head, row.pressure / 9810.0);
    EXPECT_NEAR(row.pressure, 9000.0 - 3000.0 * row.y, 1e-6);
  }
}

TEST_F(Probes, OfAnExplicitFlowTakeNodePressuresAndSaturationOfElements) {
  scene_.gravity = {};
  const Mesh<2> mesh = column_mesh(6, 5);
  const Case<2> c = model::make_case(mesh, scene_);
  const Grid<2> grid(c.mesh);
  FlowState<2> flow;
  for (const Vector<2>& x : mesh.nodes) flow.node_pressure.push_back(100.0 * x[0] - 7.0 * x[1]);
  flow.face_flux.assign(grid.face_count(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) flow.saturation.push_back(0.01 * e);
  const ElementField<2> ones(mesh.element_count(), {1.0, 1.0, 1.0});
  const Observations<2> observations(c, grid);
  const std::vector<ProbeRow> rows = observations.probe_rows(flow, {ones, ones});
  for (const ProbeRow& row : rows) {
    EXPECT_NEAR(row.pressure, 100.0 * row.x - 7.0 * row.y, 1e-12);
  }
  // The lower triangle of the second cell from the left in the fourth row from below.
  EXPECT_NEAR(rows[0].saturation, 0.01 * 2 * (3 * 6 + 1), 1e-12);
}

TEST(NodePressures, OnABoundaryWithAHeadAreThoseOfItsWater) {
  Scene scene = conduit_scene();
  scene.gravity = {0.0, -9.81, 0.0};
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.boundaries.assign(2, {});
  scene.boundaries[0].on = "left";
  scene.boundaries[0].head = 4.0;
  scene.boundaries[1].on = "right";
  scene.boundaries[1].head = 3.0;
  const Case<2> c = model::make_case(column_mesh(4, 4), scene);
  const Grid<2> grid(c.mesh);
  const int face = grid.find_face(c.mesh.boundaries[2].faces.front());
  ASSERT_EQ(face_conditions(c, grid)[face].kind, FaceKind::pressure);
  model::ModelRun run(c);
  const FlowState<2> flow = run.run({1.0}).flows.front();
  // Includes the corners, where the boundary ends.
  for (int i = 0; i < c.mesh.node_count(); ++i) {
    const Vector<2>& x = c.mesh.nodes[i];
    EXPECT_NEAR(flow.node_pressure[i] / 9810.0 + x[1], 4.0 - x[0], 1e-9) << x.transpose();
  }
}

std::string refusal(const Scene& scene) {
  const Case<2> c = model::make_case(column_mesh(2, 2), scene);
  try {
    const Grid<2> grid(c.mesh);
    const Observations<2> made(c, grid);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST_F(Probes, OutsideTheMeshAreRefused) {
  scene_.output.probes.push_back({{1.5, 0.5, 0.0}});
  scene_.output.sections = {section(0.0, 0.5, 1.0, 0.5), section(2.0, 0.0, 2.0, 1.0)};
  const std::string message = refusal(scene_);
  EXPECT_NE(message.find("output.probe[3].at: got [1.5, 0.5]; expected a place in the mesh"),
            std::string::npos)
      << message;
  EXPECT_NE(
      message.find("output.section[1]: got [2, 0] to [2, 1]; expected a line through the mesh"),
      std::string::npos)
      << message;
  scene_.output.probes.pop_back();
  scene_.output.sections.pop_back();
  EXPECT_EQ(refusal(scene_), "");
}

/// Water enters above and leaves below and to the right, with fines from the middle of the run on.
template <class Run>
void expect_boundaries_to_make_the_ledger(Run& run, double flux_in) {
  const double end = run.input().document.scene.time.end;
  for (const double time : {0.25 * end, 0.6 * end, end}) {
    run.run({time});
    const LedgerRow ledger = run.model().ledger();
    LedgerRow sum;
    double liquid_in = 0.0;
    double discharge = 0.0;
    const auto rows = run.model().boundary_rows(run.model().flow_state());
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[2].boundary, "right");
    for (const BoundaryRow& row : rows) {
      EXPECT_EQ(row.t, time);
      sum.water_in += row.water_in;
      sum.water_out += row.water_out;
      sum.fines_in += row.fines_in;
      sum.fines_out += row.fines_out;
      liquid_in += row.liquid_in;
      discharge += row.discharge;
    }
    EXPECT_NEAR(sum.water_in, ledger.water_in, 1e-14 * ledger.water_in);
    EXPECT_NEAR(sum.water_out, ledger.water_out, 1e-14 * ledger.water_out);
    EXPECT_NEAR(sum.fines_in, ledger.fines_in, 1e-14 * ledger.fines_in);
    EXPECT_NEAR(sum.fines_out, ledger.fines_out, 1e-14 * ledger.fines_out);
    EXPECT_NEAR(liquid_in, flux_in * time, 1e-10 * flux_in * time);
    EXPECT_EQ(rows[0].water_out, 0.0);
    EXPECT_GT(rows[1].water_out, 0.0);
    EXPECT_GT(rows[2].water_out, 0.0);
    EXPECT_NEAR(discharge, 0.0, 0.2 * flux_in);
  }
  EXPECT_GT(run.model().ledger().fines_out, 0.0);
}

Scene open_scene(FlowScheme scheme) {
  Scene scene = model::paper_scene();
  scene.time.scheme = scheme;
  scene.time.end = 4.0;
  scene.time.mass_scaling = scheme == FlowScheme::explicit_nodal ? 100.0 : 1.0;
  scene.initial_flow = InitialFlow::steady;
  scene.soils[0].erosion = {erosion_law("constant"), 2e-2, 1.0, false};
  scene.boundaries = {model::flux_on("top", 0.05), model::pressure_on("bottom", 0.0),
                      model::pressure_on("right", 0.0)};
  scene.boundaries[0].concentration = 0.01;
  return scene;
}

TEST(BoundaryAccounts, MakeTheLedgerOfFieldsInBothSchemes) {
  for (const FlowScheme scheme : {FlowScheme::implicit_mixed, FlowScheme::explicit_nodal}) {
    model::ModelRun run(model::make_case(column_mesh(4, 4), open_scene(scheme)));
    expect_boundaries_to_make_the_ledger(run, 0.05);
  }
}

TEST(BoundaryAccounts, MakeTheLedgerOfPoints) {
  for (const PressureIntegration integration :
       {PressureIntegration::mixed, PressureIntegration::material_point}) {
    const bool carried = integration == PressureIntegration::material_point;
    Scene scene = open_scene(carried ? FlowScheme::explicit_nodal : FlowScheme::implicit_mixed);
    scene.formulation = Formulation::double_point;
    scene.flow.integration = integration;
    model::DoublePointRun run(model::make_double_point_case(column_mesh(4, 4), scene));
    expect_boundaries_to_make_the_ledger(run, 0.05);
  }
}

TEST(BoundaryAccounts, WallsThatLetLiquidThroughHaveRowsOfTheirOwn) {
  Scene scene = open_scene(FlowScheme::implicit_mixed);
  scene.walls = {{"left", 1e-6}, {"tight", 0.0}};
  const Case<2> c = model::make_case(column_mesh(2, 2), scene);
  const Grid<2> grid(c.mesh);
  BoundaryAccounts<2> accounts(c, grid);
  std::vector<double> volumes(grid.face_count(), 0.0);
  const int upper = grid.find_face(c.mesh.boundaries[2].faces[1]);
  const int lower = grid.find_face(c.mesh.boundaries[2].faces[0]);
  volumes[upper] = 0.5;
  volumes[lower] = -0.5;
  accounts.book_liquid(volumes);
  accounts.book(upper, 3.0, 0.25);
  const std::vector<BoundaryRow> rows = accounts.rows(1.0, volumes);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[3].boundary, "left");
  EXPECT_EQ(rows[3].liquid_out, 0.5);
  EXPECT_EQ(rows[3].liquid_in, 0.5);
  EXPECT_EQ(rows[3].discharge, 0.0);
  EXPECT_EQ(rows[3].water_out, 3.0);
  EXPECT_EQ(rows[3].fines_out, 0.25);
}

/// All new tables as text, with every bit.
template <class Model>
std::string lines_of(const Model& model) {
  const FlowState<2> flow = model.flow_state();
  std::string lines;
  for (const auto& row : model.boundary_rows(flow)) lines += table_line(row);
  for (const auto& row : model.probe_rows(flow)) lines += table_line(row);
  for (const auto& row : model.section_rows(flow)) lines += table_line(row);
  return lines;
}

template <class Run>
void expect_to_go_on(const Case<2>& c) {
  Run whole(c);
  whole.run({1.5});
  StateArchive collects;
  collects(whole.model());
  whole.run({2.0, 3.0});
  Run resumed(c);
  EXPECT_NE(lines_of(resumed.model()), lines_of(whole.model()));
  StateArchive restores(collects.finish());
  restores(resumed.model());
  restores.finish();
  resumed.run({2.0, 3.0});
  EXPECT_EQ(lines_of(resumed.model()), lines_of(whole.model()));
}

TEST(BoundaryAccounts, ProbesAndSectionsGoOnWithTheSameBits) {
  Scene scene = open_scene(FlowScheme::implicit_mixed);
  scene.output.probes = {{{0.3, 0.4, 0.0}}};
  scene.output.sections = {section(0.0, 0.3, 1.0, 0.77)};
  expect_to_go_on<model::ModelRun>(model::make_case(column_mesh(4, 4), scene));
  scene.formulation = Formulation::double_point;
  expect_to_go_on<model::DoublePointRun>(model::make_double_point_case(column_mesh(4, 4), scene));
}

const Field* find(const std::vector<Field>& fields, const std::string& name) {
  const auto found = std::ranges::find(fields, name, &Field::name);
  return found == fields.end() ? nullptr : &*found;
}

TEST(Snapshots, HaveHeadsUnderGravityAndSaturationsWhereTheFlowHasThem) {
  Scene scene = conduit_scene();
  model::ModelRun dry(model::make_case(column_mesh(3, 3), scene));
  EXPECT_EQ(find(dry.model().snapshot(dry.model().flow_state()).node, "head"), nullptr);
  scene.gravity = {0.0, -9.81, 0.0};
  model::ModelRun run(model::make_case(column_mesh(3, 3), scene));
  FlowState<2> flow = run.model().flow_state();
  EXPECT_EQ(find(run.model().snapshot(flow).cell, "saturation"), nullptr);
  flow.saturation.assign(18, 0.5);
  const Snapshot snapshot = run.model().snapshot(flow);
  const Field* head = find(snapshot.node, "head");
  ASSERT_NE(head, nullptr);
  EXPECT_EQ(head->unit, "m");
  const auto& nodes = run.input().mesh.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_NEAR(head->values[i], flow.node_pressure[i] / 9810.0 + nodes[i][1], 1e-12);
  }
  ASSERT_NE(find(snapshot.cell, "saturation"), nullptr);
  EXPECT_EQ(find(snapshot.cell, "saturation")->values, flow.saturation);
}

/// Soil that holds less liquid than the round-off of its pores, or none.
TEST(Snapshots, HaveThePorosityOfSoilThatIsNearlyDry) {
  Scene scene = conduit_scene();
  model::ModelRun run(model::make_case(column_mesh(3, 3), scene));
  FlowState<2> flow = run.model().flow_state();
  flow.saturation.assign(18, 0.0);
  flow.porosity.assign(18, 0.25);
  const Snapshot snapshot = run.model().snapshot(flow);
  EXPECT_EQ(find(snapshot.cell, "porosity")->values, flow.porosity);
  for (const double n : find(snapshot.element_vertex, "porosity")->values) {
    EXPECT_NEAR(n, 0.25, 1e-15);
  }
  // The centroid of an element.
  scene.output.probes = {{{2.0 / 9.0, 1.0 / 9.0, 0.0}}};
  const Case<2> c = model::make_case(column_mesh(3, 3), scene);
  const Grid<2> grid(c.mesh);
  const Observations<2> observations(c, grid);
  const ElementField<2> little(18, {1e-20, 2e-20, 3e-20});
  EXPECT_NEAR(observations.probe_rows(flow, {little, little}).at(0).porosity, 0.25, 1e-15);
  const ElementField<2> none(18, {0.0, 0.0, 0.0});
  EXPECT_EQ(observations.probe_rows(flow, {none, none}).at(0).porosity, 0.25);
}

/// Soil between smooth walls on rigid soil: a load compresses it while its fines erode.
TEST(Snapshots, OfMovingSoilHaveTheErodibleFinesOfThePoints) {
  Scene scene = conduit_scene();
  scene.time.end = 40.0;
  scene.time.step = 1.0;
  scene.initial_flow = InitialFlow::rest;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.soils[0].skeleton = model::elastic_soil(1e6, 0.0);
  scene.soils[0].erosion.law = erosion_law("constant");
  scene.soils[0].erosion.rate = 1e-3;
  scene.soils.push_back(scene.soils[0]);
  scene.soils[1].region = "base";
  scene.soils[1].skeleton = {};
  scene.soils[1].porosity_gradient = {0.05, 0.02, 0.0};
  BoundaryCondition top = model::clean_pressure_on("top", 0.0);
  top.traction = VectorFunction{{{0.0, {0.0, 0.0, 0.0}}, {40.0, {0.0, -2e5, 0.0}}}};
  scene.boundaries = {top, model::fixed_on("bottom", Fixing::both),
                      model::fixed_on("left", Fixing::normal),
                      model::fixed_on("right", Fixing::normal)};
  Mesh<2> mesh = column_mesh(2, 8);
  mesh.region_names.emplace_back("base");
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = element_centroid(mesh, e)[1] < 0.25 ? 1 : 0;
  }
  model::ModelRun run(model::make_case(std::move(mesh), scene));
  const Snapshot snapshot = run.run({40.0}, true).snapshots.back();
  const auto of_points = [&](const char* name) { return find(snapshot.solid, name)->values; };
  const std::vector<double> fraction = of_points("erodible_fraction");
  const std::vector<double> volume = of_points("volume");
  const std::vector<double> element = of_points("element");
  const Grid<2>& grid = run.model().grid();
  std::vector<double> sum(grid.volume.size());
  for (std::size_t p = 0; p < volume.size(); ++p) {
    const auto e = static_cast<std::size_t>(element[p]);
    sum[e] += fraction[p] * volume[p] / grid.volume[e];
  }
  const std::vector<double> cells = find(snapshot.cell, "erodible_fraction")->values;
  const std::vector<double> porosity = find(snapshot.cell, "porosity")->values;
  for (std::size_t e = 0; e < sum.size(); ++e) {
    if (grid.mesh.element_region[e] == 1) {
      EXPECT_EQ(cells[e], 0.4 - porosity[e]) << e;
    } else {
      EXPECT_NEAR(cells[e], sum[e], 1e-14) << e;
    }
  }
  EXPECT_EQ(std::ranges::min(cells), 0.0) << "the soil has sunk from the uppermost elements";
}

/// Free water has no grains until soil slides into it: the residual is a share of that soil.
TEST(MassAccounts, TakeSoilThatSlidInAsMassOfTheRegion) {
  const Case<2> c = model::make_case(column_mesh(2, 2), conduit_scene());
  const Grid<2> grid(c.mesh);
  MassAccounts<2> masses(c, grid);
  masses.open({Stored{}, Stored{}});
  Stored now;
  now.carried = 500.0;
  now.solid = 500.0 * (1.0 + 1e-9);
  EXPECT_NEAR(masses.ledger(1.0, {now, now}).residual_grains, 1e-9, 1e-15);
}

/// The highest place is free water, which cannot drain: only soil raises the warning.
TEST(Suction, IsSaidOfSoilAlone) {
  LayerSettings layers;
  layers.inflow = layers.above = layers.below = layers.outflow = 1;
  Scene scene = model::double_point_scene(1e-4, 0.0);
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.water_level = -1.0;
  scene.initial_flow = InitialFlow::rest;
  model::DoublePointRun run(
      model::make_double_point_case(model::layered_mesh(4, layers), std::move(scene)));
  int found = 0;
  for (const std::string& warning : run.model().take_warnings()) {
    if (warning.find("under suction") == std::string::npos) continue;
    EXPECT_NE(warning.find("soil \"buffer\""), std::string::npos) << warning;
    ++found;
  }
  EXPECT_EQ(found, 1);
}

/// A linear fit of the concentrations of points exceeds their range and may even reach the value at
/// which grains lock; soil erodes with the mean concentration of its element.
TEST(DoublePointSnapshot, ErodesAsTheStepDoes) {
  Scene scene = model::double_point_scene(0.012, 1e-3);
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.soils[0].erosion.critical_concentration = 0.4;
  scene.boundaries = {model::flux_on("top", 0.012), model::pressure_on("bottom", 0.0)};
  model::DoublePointRun run(model::make_double_point_case(column_mesh(2, 4), scene));
  const Snapshot snapshot = run.run({10.0}, true).snapshots.back();
  const auto field = [&](const char* name) {
    return std::ranges::find(snapshot.solid, name, &Field::name)->values;
  };
  const std::vector<double> rate = field("erosion_rate");
  const std::vector<double> fitted = field("concentration");
  const std::vector<int>& element = run.input().solid_points.element;
  double spread = 0.0;
  for (std::size_t p = 1; p < rate.size(); ++p) {
    if (element[p] != element[p - 1]) continue;
    EXPECT_EQ(rate[p], rate[p - 1]) << p;
    spread = std::max(spread, std::abs(fitted[p] - fitted[p - 1]));
  }
  EXPECT_GT(spread, 1e-3);
  EXPECT_GT(rate.front(), 0.0);
}

}  // namespace flow_results_test
}  // namespace suffuse

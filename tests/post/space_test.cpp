// Models in space: cuts, surfaces, samples and pictures of boxes of tetrahedra with linear fields.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "box_mesh.hpp"
#include "checks/heave_safety.hpp"
#include "common/errors.hpp"
#include "drawing/space.hpp"
#include "figures/figures.hpp"
#include "figures/render.hpp"
#include "post/picture_pixels.hpp"
#include "post/synthetic_results.hpp"
#include "scene/scene_defaults.hpp"
#include "tables/reference_error.hpp"
#include "values/derived_fields.hpp"
#include "values/flow_paths.hpp"
#include "values/sample.hpp"
#include "values/sheet.hpp"
#include "values/specimen.hpp"

namespace suffuse {
namespace space_test {

using testing::ScratchFolder;

const Vector<3> size(1.0, 0.5, 0.75);
const std::string command = "suffuse-post render";

/// Two regions, to the left and right of x = 0.5 m.
Mesh<3> box() {
  Mesh<3> mesh = model::box_mesh({4, 2, 3}, size);
  mesh.region_names = {"specimen", "sand"};
  mesh.element_region.clear();
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region.push_back(element_centroid(mesh, e)[0] < 0.5 ? 0 : 1);
  }
  return mesh;
}

double linear(const Vector<3>& x) {
  return 0.3 + 0.2 * x[0] - 0.1 * x[1] + 0.05 * x[2];
}

std::vector<double> at_nodes(const Mesh<3>& mesh) {
  std::vector<double> values;
  for (const Vector<3>& x : mesh.nodes) values.push_back(linear(x));
  return values;
}

std::vector<double> at_vertices(const Mesh<3>& mesh) {
  std::vector<double> values;
  for (const auto& element : mesh.elements) {
    for (const int node : element) values.push_back(linear(mesh.nodes[node]));
  }
  return values;
}

double area(const Mesh<3>& mesh, const Sheet& sheet) {
  double sum = 0.0;
  for (const auto& [a, b, c] : sheet.triangles) {
    const Vector<3> x = position(mesh, sheet.nodes[a]);
    sum +=
        0.5 * (position(mesh, sheet.nodes[b]) - x).cross(position(mesh, sheet.nodes[c]) - x).norm();
  }
  return sum;
}

std::string message_of(const std::function<void()>& run) {
  try {
    run();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Sheet, CutsHaveTheAreaOfTheBoxBetweenNodesThroughThemAndAtBothEnds) {
  const Mesh<3> mesh = box();
  for (int axis = 0; axis < 3; ++axis) {
    const double whole = size.prod() / size[axis];
    for (const double share : {0.0, 0.2, 0.25, 1.0 / 3.0, 0.5, 0.61, 1.0}) {
      const PlaneCut cut = plane_cut(mesh, {axis, share * size[axis]}, command);
      double sum = 0.0;
      for (int t = 0; t < cut.mesh.element_count(); ++t) {
        ASSERT_GT(element_volume(cut.mesh, t), 0.0);
        sum += element_volume(cut.mesh, t);
      }
      EXPECT_NEAR(sum, whole, 1e-14) << axis << " " << share;
    }
  }
}

TEST(Sheet, CutsHoldRegionsBoundariesAndLinearFields) {
  const Mesh<3> mesh = box();
  for (const double y : {0.0, 0.1, 0.25, 0.5}) {
    const PlaneCut cut = plane_cut(mesh, {1, y}, command);
    const auto node = sheet_values(mesh, cut.sheet, "node", at_nodes(mesh));
    const auto vertex = sheet_values(mesh, cut.sheet, "element_vertex", at_vertices(mesh));
    for (int t = 0; t < cut.mesh.element_count(); ++t) {
      EXPECT_EQ(cut.mesh.element_region[t], element_centroid(cut.mesh, t)[0] < 0.5 ? 0 : 1);
      for (int a = 0; a < 3; ++a) {
        const int i = cut.mesh.elements[t][a];
        const Vector<2>& x = cut.mesh.nodes[i];
        EXPECT_NEAR(node[i], linear({x[0], y, x[1]}), 1e-15);
        EXPECT_NEAR(vertex[3 * t + a], linear({x[0], y, x[1]}), 1e-15);
      }
    }
    if (y == 0.0 || y == 0.5) continue;  // the cut is a boundary itself
    double length = 0.0;
    EXPECT_EQ(cut.mesh.boundaries.size(), 4U);
    for (const auto& boundary : cut.mesh.boundaries) {
      for (const auto& [a, b] : boundary.faces) {
        length += (cut.mesh.nodes[a] - cut.mesh.nodes[b]).norm();
      }
    }
    EXPECT_NEAR(length, 2.0 * (size[0] + size[2]), 1e-14);
  }
}

TEST(Sheet, NeighboursInACutShareNodes) {
  const Mesh<3> mesh = box();
  for (const double y : {0.1, 0.25}) {
    const PlaneCut cut = plane_cut(mesh, {1, y}, command);
    double outline = 0.0;
    for (const auto& [a, b] : outer_edges(cut.mesh)) {
      outline += (cut.mesh.nodes[a] - cut.mesh.nodes[b]).norm();
    }
    EXPECT_NEAR(outline, 2.0 * (size[0] + size[2]), 1e-14);
    double between = 0.0;
    for (const auto& [a, b] : region_edges(cut.mesh)) {
      between += (cut.mesh.nodes[a] - cut.mesh.nodes[b]).norm();
    }
    EXPECT_NEAR(between, size[2], 1e-14);
  }
}

TEST(Sheet, LevelsOfALinearFieldArePlanes) {
  // A plane across the diagonal of the unit cube, through its middle, is a regular hexagon.
  const Mesh<3> mesh = model::box_mesh({3, 4, 5});
  std::vector<double> sums;
  for (const Vector<3>& x : mesh.nodes) sums.push_back(x.sum());
  EXPECT_NEAR(area(mesh, level_sheet(mesh, sums, 1.5)), 0.75 * std::numbers::sqrt3, 1e-13);
  EXPECT_TRUE(level_sheet(mesh, sums, 3.5).triangles.empty());
  sums.front() = std::nan("");
  EXPECT_TRUE(level_sheet(mesh, sums, 0.1).triangles.empty());
}

TEST(Sheet, LevelsOfADistanceTendToTheSphere) {
  std::array<double, 2> error{};
  for (const int level : {0, 1}) {
    const int n = 8 << level;
    const Mesh<3> mesh = model::box_mesh({n, n, n});
    std::vector<double> distance;
    for (const Vector<3>& x : mesh.nodes) distance.push_back((x - Vector<3>::Constant(0.5)).norm());
    const double exact = 4.0 * std::numbers::pi * 0.4 * 0.4;
    error.at(level) = std::abs(area(mesh, level_sheet(mesh, distance, 0.4)) / exact - 1.0);
  }
  EXPECT_LT(error[1], 0.01);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2.0, 0.3);
}

TEST(Sheet, TheSurfaceOfABoxIsClosedAndLooksOutwards) {
  const Mesh<3> mesh = box();
  const Sheet surface = outer_sheet(mesh);
  EXPECT_NEAR(area(mesh, surface), 2.0 * (0.5 + 0.375 + 0.75), 1e-14);
  // The flux of the position through a closed surface is three times the volume (Gauss).
  double flux = 0.0;
  for (const auto& [a, b, c] : surface.triangles) {
    const Vector<3> x = position(mesh, surface.nodes[a]);
    const Vector<3> y = position(mesh, surface.nodes[b]);
    flux += x.dot(y.cross(position(mesh, surface.nodes[c]))) / 2.0;
  }
  EXPECT_NEAR(flux, 3.0 * size.prod(), 1e-14);
}

TEST(Sheet, NodeMeansKeepALinearFieldInsideAndConstantsEverywhere) {
  const Mesh<3> mesh = box();
  const auto means = node_means(mesh, "element_vertex", at_vertices(mesh));
  for (int i = 0; i < mesh.node_count(); ++i) EXPECT_NEAR(means[i], linear(mesh.nodes[i]), 1e-15);
  for (const double mean : node_means(mesh, "cell", std::vector(mesh.elements.size(), 0.7))) {
    EXPECT_NEAR(mean, 0.7, 1e-15);
  }
}

TEST(FlowPaths, OfAUniformFluxAreStraightAndShareTheDischarge) {
  const Mesh<3> mesh = box();
  const Vector<3> flux(3e-4, 1e-4, -2e-4);
  std::vector<double> values;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int i = 0; i < 3; ++i) values.push_back(flux[i]);
  }
  const FlowPaths flow = flow_paths(mesh, values, 40);
  // Liquid enters through the left side, the front and the top.
  const Vector<3> areas(size[1] * size[2], size[0] * size[2], size[0] * size[1]);
  EXPECT_NEAR(flow.discharge, flux.cwiseAbs().dot(areas), 1e-15);
  ASSERT_EQ(flow.paths.size(), 40U);
  int from_the_left = 0;
  for (const FlowPath& path : flow.paths) {
    ASSERT_EQ(path.places.size(), path.elements.size() + 1);
    const Vector<3>& start = path.places.front();
    for (const Vector<3>& x : path.places) {
      EXPECT_NEAR((x - start).cross(flux).norm(), 0.0, 1e-15);
    }
    // Each path leads from the surface to the surface.
    const Vector<3>& end = path.places.back();
    EXPECT_NEAR(std::min({start[0], start[1], size[2] - start[2]}), 0.0, 1e-12);
    EXPECT_NEAR(std::min({size[0] - end[0], size[1] - end[1], end[2]}), 0.0, 1e-12);
    from_the_left += start[0] < 1e-12 ? 1 : 0;
  }
  EXPECT_NEAR(from_the_left, 40 * flux[0] * areas[0] / flow.discharge, 2.0);
}

TEST(FlowPaths, EndWhereLiquidRests) {
  const Mesh<3> mesh = box();
  std::vector<double> values(3UL * mesh.element_count(), 0.0);
  EXPECT_TRUE(flow_paths(mesh, values, 40).paths.empty());
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (element_centroid(mesh, e)[0] < 0.5) values[3UL * e] = 1e-4;
  }
  for (const FlowPath& path : flow_paths(mesh, values, 40).paths) {
    EXPECT_NEAR(path.places.back()[0], 0.5, 1e-12);
  }
}

TEST(Sheet, ReadsPlanesAndRefusesOthers) {
  EXPECT_EQ(parse_cut("x=1.5", command).axis, 0);
  EXPECT_EQ(parse_cut("z=-2e-3", command).at, -2e-3);
  for (const std::string text : {"1.5", "y=", "y=nan", "w=1", "x=1,2"}) {
    EXPECT_EQ(
        message_of([&] { parse_cut(text, command); }),
        command + ": --cut: got \"" + text + "\"; expected x=, y= or z= and a number in metres");
  }
  EXPECT_EQ(
      message_of([] {
        plane_cut(box(), {1, 0.6}, command);
      }),
      command + ": --cut: got y = 0.6 m; expected a plane through the model, y from 0 to 0.5 m");
}

TEST(SpaceView, IsARotationAndShowsTheUpwardDirectionUpwards) {
  for (const Vector<3>& upward :
       {Vector<3>(0, 0, 1), Vector<3>(0, 1, 0), Vector<3>(1, 0, 0), Vector<3>(0, 0, -1)}) {
    const SpaceView view = space_view(upward);
    EXPECT_NEAR(view.right.dot(view.up), 0.0, 1e-15);
    EXPECT_NEAR((view.right.cross(view.up) - view.toward).norm(), 0.0, 1e-15);
    EXPECT_NEAR(view.right.dot(upward), 0.0, 1e-15);
    EXPECT_GT(view.up.dot(upward), 0.5);
  }
}

/// Results of the box: porosity linear at vertices and rising in time, pressure of a head of 1 m +
/// x, flux and gradient uniform.
class Space : public ::testing::Test {
 protected:
  Space() {
    unsetenv("DISPLAY");
    write();
  }
  void write() const {
    Case<3> c;
    c.mesh = box();
    c.document = parse_scene(scene(), "box.toml");
    complete_for_mesh(c.document, 3);
    for (int e = 0; e < c.mesh.element_count(); ++e) {
      c.solid_points.element.push_back(e);
      c.solid_points.barycentric.push_back({0.25, 0.25, 0.25, 0.25});
      c.solid_points.volume.push_back(element_volume(c.mesh, e));
    }
    ResultsWriter<3> writer(scratch / "run.results", c);
    for (const double t : {0.0, 10.0}) writer.write_snapshot(snapshot(c.mesh, t));
    const std::array<BoundaryRow, 2> rows{{{10.0, "bottom", 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -2e-3},
                                           {10.0, "top", 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 2e-3}}};
    writer.append_boundaries(rows);
    RunInfo info;
    info.status = "done";
    info.elements = c.mesh.element_count();
    writer.write_run_info(info);
  }
  static std::string scene() {
    std::string soil =
        "porosity = 0.3\nskeleton_fraction = 0.5\ngrain_density = 2650.0\n"
        "porosity_gradient = [0.1, 0.2, -0.1]\nconductivity = 1.0e-3\n";
    return "name = \"box\"\nformulation = \"single-point\"\ngravity = [0.0, 0.0, -10.0]\n"
           "[geometry]\nshape = \"box\"\nwidth = 1.0\ndepth = 0.5\nheight = 0.75\n"
           "[mesh]\nsize = 0.25\n[liquid]\ndensity = 1000.0\nbulk_modulus = 2.0e9\n"
           "viscosity = 1.0e-3\n[soil.specimen]\n" +
           soil + "[soil.sand]\n" + soil +
           "[[boundary]]\non = \"bottom\"\npressure = 2.0e4\n[[boundary]]\non = \"top\"\n"
           "pressure = 0.0\n[initial]\nflow = \"steady\"\n[time]\nend = 10.0\n[output]\nevery = "
           "10.0\n";
  }
  static Snapshot snapshot(const Mesh<3>& mesh, double t) {
    Snapshot s;
    s.time = t;
    s.step = t > 0.0 ? 1 : 0;
    Field porosity{"porosity", "1", 1, {}};
    Field vertex{"porosity", "1", 4, at_vertices(mesh)};
    for (double& value : vertex.values) value += 1e-3 * t;
    Field pressure{"pressure", "Pa", 1, {}};
    Field nodal{"pressure", "Pa", 1, {}};
    Field flux{"darcy_flux", "m/s", 3, {}};
    Field gradient{"hydraulic_gradient", "1", 3, {}};
    for (int e = 0; e < mesh.element_count(); ++e) {
      const Vector<3> x = element_centroid(mesh, e);
      porosity.values.push_back(linear(x) + 1e-3 * t);
      pressure.values.push_back(1e4 * (1.0 + x[0] - x[2]));
      flux.values.insert(flux.values.end(), {1e-4, 2e-4, 3e-4});
      gradient.values.insert(gradient.values.end(), {0.1, 0.2, 0.5});
    }
    for (const Vector<3>& x : mesh.nodes) nodal.values.push_back(1e4 * (1.0 + x[0] - x[2]));
    s.cell = {porosity, pressure, flux, gradient};
    s.node = {nodal};
    s.solid = {Field{"porosity", "1", 1, porosity.values}};
    s.element_vertex = {vertex};
    return s;
  }
  [[nodiscard]] ResultsReader run() const { return ResultsReader(scratch / "run.results"); }
  [[nodiscard]] RenderRequest request(const std::string& field) const {
    RenderRequest r;
    r.field = field;
    r.output = scratch / "picture.png";
    return r;
  }
  [[nodiscard]] std::string refusal(const RenderRequest& r) const {
    return message_of([&] { render(run(), r); });
  }

  const ScratchFolder scratch;
};

TEST_F(Space, SamplesAreLinearInSpaceAndTime) {
  const SampleLine line = parse_line("0,0,0:1,0.5,0.75");
  const Table table =
      sample(run(), {{4.0}, places_on(line, 7), {"porosity", "head", "darcy_flux"}});
  EXPECT_EQ(table.names,
            (std::vector<std::string>{"t", "x", "y", "z", "porosity", "head", "darcy_flux_x",
                                      "darcy_flux_y", "darcy_flux_z"}));
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const Vector<3> x(table.columns[1][i], table.columns[2][i], table.columns[3][i]);
    EXPECT_NEAR(table.columns[4][i], linear(x) + 4e-3, 1e-15);
    EXPECT_NEAR(table.columns[5][i], 1.0 + x[0], 1e-15);
    EXPECT_EQ(table.columns[8][i], 3e-4);
  }
  EXPECT_EQ(message_of([&] {
              sample(run(), {{4.0}, {parse_place("0.5,0.5")}, {"head"}});
            }),
            "suffuse-post sample: --line: got the point (0.5, 0.5); expected x,y,z: the model has "
            "three dimensions");
}

TEST_F(Space, ErrorsAgainstAReferenceWithPlacesInSpace) {
  ReferenceTable reference{"known.csv",
                           {{"t", "x", "y", "z", "head"},
                            {{10.0, 10.0}, {0.1, 0.9}, {0.2, 0.3}, {0.7, 0.1}, {1.1, 2.0}}}};
  const auto errors = reference_errors(run(), reference);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NEAR(errors[0].max, 0.05, 1e-14);  // 1.9 instead of 2
}

TEST_F(Space, SafetyIsThatOfTheUpwardGradient) {
  const auto parts = safety_of(run());
  ASSERT_EQ(parts.size(), 3U);
  ASSERT_TRUE(parts[0].least);
  // The least (1 - n) is where x is large, y small and z large, at the last time.
  EXPECT_NEAR(parts[0].least->gradient, 0.5, 1e-15);
  EXPECT_EQ(parts[0].least->time, 10.0);
  EXPECT_EQ(parts[0].least->place.size(), 3U);
  EXPECT_GT(parts[0].least->place[0], 0.75);
  EXPECT_EQ(parts[1].name, "bottom");
  EXPECT_FALSE(parts[1].least);  // water enters there
  EXPECT_TRUE(parts[2].least);
  EXPECT_NE(safety_text(run(), parts).find("discharge now (m3/s)"), std::string::npos);
}

TEST_F(Space, TheSpecimenIntegratesTheGradientsOfItsPorosity) {
  const Specimen whole = specimen(run());
  EXPECT_NEAR(whole.volume, size.prod(), 1e-14);
  // Squares are integrated exactly too: those of n = 0.3 + g . x over the box.
  const auto square = [](const Soil&, double before, double) { return before * before; };
  const Vector<3> g(0.1, 0.2, -0.1);
  const double mean = 0.3 + g.dot(size) / 2.0;
  const double spread = (g.array() * size.array()).square().sum() / 12.0;
  EXPECT_NEAR(integrate(whole, 0.0, square), size.prod() * (mean * mean + spread), 1e-15);
}

TEST_F(Space, PicturesOfSurfaceCutAndLevels) {
  RenderRequest r = request("region");
  r.mesh = false;
  render(run(), r);
  const testing::Pixels surface(r.output);
  // The front is seen at its true place: the view is that of space_view, fitted into the picture.
  const SpaceView view = space_view(Vector<3>::UnitZ());
  const double left = view.project({0.0, 0.0, 0.0})[0];
  const double low = view.project({1.0, 0.0, 0.0})[1];
  const double width = view.project({1.0, 0.5, 0.0})[0] - left;
  const double height = view.project({0.0, 0.5, 0.75})[1] - low;
  const double scale = std::min(1000.0 / width, 800.0 / height);
  const auto pixel = [&](const Vector<3>& x) {
    const Vector<3> on = view.project(x);
    return Eigen::Vector2d(axes_left + scale * (on[0] - left), axes_bottom + scale * (on[1] - low));
  };
  const auto first = surface.at(pixel({0.2, 0.0, 0.4}));
  const auto second = surface.at(pixel({0.8, 0.0, 0.4}));
  EXPECT_NE(first, second);
  EXPECT_EQ(surface.at(pixel({0.2, 0.3, 0.75})), first);
  EXPECT_EQ(surface.at(pixel({1.0, 0.3, 0.3})), second);
  r = request("porosity");
  r.cut = CutPlane{0, 0.3};
  r.vectors = r.contours = true;
  render(run(), r);
  EXPECT_GT(testing::Pixels(r.output).color_count(), 100U);
  r.output = scratch / "cut.svg";
  render(run(), r);
  EXPECT_NE(testing::file_text(r.output).find(", 10 s, x = 0.3 m"), std::string::npos);
  r = request("porosity");
  r.levels = {0.35, 0.45};
  render(run(), r);
  EXPECT_GT(testing::Pixels(r.output).inked(), 10'000);
}

TEST_F(Space, TheCameraSaysFromWhereAModelIsSeen) {
  const SpaceView right = space_view(Vector<3>::UnitZ(), {90.0, 0.0});
  EXPECT_NEAR((right.toward - Vector<3>::UnitX()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((right.right - Vector<3>::UnitY()).norm(), 0.0, 1e-12);
  RenderRequest r = request("porosity");
  const auto width_from = [&](double azimuth) {
    r.camera = Camera{azimuth, 0.0};
    render(run(), r);
    return testing::Pixels(r.output).width();
  };
  // The box is 1 m wide, 0.5 m deep and 0.75 m high: narrower from the right.
  EXPECT_GT(width_from(0.0), width_from(90.0) + 400);
  EXPECT_EQ(width_from(0.0), width_from(180.0));
  EXPECT_EQ(parse_camera("120,30").azimuth, 120.0);
  EXPECT_THROW((void)parse_camera("120,90"), InputError);
  EXPECT_THROW((void)parse_camera("120"), InputError);
  r.cut = CutPlane{0, 0.3};
  EXPECT_EQ(refusal(r), command +
                            ": --camera: got it with --cut; expected it with a model in space "
                            "that is seen from outside");
}

TEST_F(Space, StreamlinesAreDrawn) {
  RenderRequest r = request("porosity");
  r.streamlines = true;
  render(run(), r);
  const std::size_t edges_and_lines = testing::Pixels(r.output).inked();
  r.streamlines = false;
  r.levels = {100.0};  // no surface: the edges alone
  render(run(), r);
  EXPECT_GT(edges_and_lines, testing::Pixels(r.output).inked() + 5'000);
}

TEST_F(Space, SketchAndProfileAreDrawn) {
  draw_figure("model", {run()}, scratch / "model.png");
  EXPECT_GT(testing::Pixels(scratch / "model.png").inked(), 10'000);
  FigureOptions options;
  options.line = "0,0.1,0.1:1,0.1,0.1";
  options.fields = "head";
  const auto charts = make_figure("profile", {run()}, options);
  ASSERT_EQ(charts.size(), 1U);
  EXPECT_NEAR(charts[0].curves[0].y.back(), 2.0, 1e-14);
}

TEST_F(Space, WhatHasNoSenseIsRefused) {
  const std::string start = command + ": ";
  RenderRequest r = request("porosity");
  r.contours = true;
  EXPECT_EQ(refusal(r), start +
                            "--contours: got it without --cut; expected --cut, the plane that "
                            "shows it");
  r = request("porosity");
  r.streamlines = true;
  r.cut = CutPlane{0, 0.3};
  EXPECT_EQ(refusal(r), start +
                            "--streamlines: got it with --cut; expected --vectors: a cut has no "
                            "streamlines of its own");
  r = request("porosity");
  r.on = "solid";
  EXPECT_EQ(refusal(r), start +
                            "--on: got \"solid\" of a model in space; expected \"cell\" or "
                            "\"node\"; ParaView shows the points");
  r = request("porosity");
  r.output = scratch / "picture.svg";
  EXPECT_EQ(refusal(r), start + "-o: got \"" + r.output +
                            "\" for a model seen from outside; expected a .png, or --cut");
  EXPECT_EQ(message_of([&] { draw_figure("flownet", {run()}, scratch / "net.png"); }),
            scratch / "run.results" +
                ": got results of three dimensions; expected a plane model. Of these, render draws "
                "surfaces and cuts, sample and the figure profile follow lines");
}

}  // namespace space_test
}  // namespace suffuse

#include "figures/seepage_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/errors.hpp"
#include "drawing/contours.hpp"
#include "figures/figures.hpp"
#include "figures/render.hpp"
#include "post/picture_pixels.hpp"
#include "post/synthetic_results.hpp"
#include "values/fields.hpp"

namespace suffuse {
namespace seepage_map_test {

using testing::file_text;
using testing::Pixels;
using testing::ScratchFolder;

BoundaryCondition head_on(const std::string& name, TimeFunction head) {
  BoundaryCondition boundary;
  boundary.on = name;
  boundary.head = std::move(head);
  return boundary;
}

/// A dam 8 m high with slopes of 1:2 on both sides, in columns of cells; boundaries upstream and
/// downstream. The number of triangles is 2 nx ny.
Mesh<2> dam_mesh(int nx, int ny) {
  constexpr double height = 8.0;
  Mesh<2> mesh;
  const auto node = [&](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const double y = height * j / ny;
      mesh.nodes.emplace_back(2.0 * y + (36.0 - 4.0 * y) * i / nx, y);
    }
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      mesh.elements.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1)});
      mesh.elements.push_back({node(i, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  mesh.region_names = {"dam"};
  mesh.boundaries = {{"upstream", {}}, {"downstream", {}}};
  for (int j = 0; j < ny; ++j) {
    mesh.boundaries[0].faces.push_back({node(0, j), node(0, j + 1)});
    mesh.boundaries[1].faces.push_back({node(nx, j), node(nx, j + 1)});
  }
  return mesh;
}

Scene dam_scene() {
  Scene scene;
  scene.liquid.density = 1000.0;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.boundaries = {head_on("upstream", 6.0), head_on("downstream", 1.0)};
  return scene;
}

/// After Dupuit, between the heads of both sides: h^2 is linear in x from water line to water line.
SeepageMap dam_map(int nx, int ny) {
  SeepageMap map;
  map.title = "dam, t = 0 s";
  map.label = "head h (m)";
  map.mesh = dam_mesh(nx, ny);
  for (const Vector<2>& x : map.mesh.nodes) {
    const double share = std::clamp((x[0] - 12.0) / (34.0 - 12.0), 0.0, 1.0);
    map.head.push_back(std::sqrt(36.0 - 35.0 * share));
    map.pressure.push_back(9810.0 * (map.head.back() - x[1]));
  }
  map.water = outside_water(map.mesh, dam_scene(), 0.0, 2.5);
  return map;
}

double sum_of_areas(const OutsideWater& water) {
  double sum = 0.0;
  for (const auto& q : water.body) {
    double twice = 0.0;
    for (int a = 0; a < 4; ++a) {
      const Vector<2>& x = q.at(a);
      const Vector<2>& y = q.at((a + 1) % 4);
      twice += x[0] * y[1] - x[1] * y[0];
    }
    sum += 0.5 * std::abs(twice);
  }
  return sum;
}

TEST(OutsideWater, LiesOverSlopesUpToTheLevel) {
  const auto waters = outside_water(dam_mesh(10, 8), dam_scene(), 0.0, 2.5);
  ASSERT_EQ(waters.size(), 2U);
  EXPECT_EQ(waters[0].boundary, "upstream");
  EXPECT_EQ(waters[0].head, 6.0);
  EXPECT_NEAR(sum_of_areas(waters[0]), 0.5 * 6.0 * 12.0, 1e-12);
  EXPECT_NEAR(waters[0].level[0][0], 0.0, 1e-12);
  EXPECT_NEAR(waters[0].level[1][0], 12.0, 1e-12);
  EXPECT_NEAR(waters[0].level[1][1], 6.0, 1e-12);
  EXPECT_NEAR(sum_of_areas(waters[1]), 0.5 * 1.0 * 2.0, 1e-12);
  // The level is too short for its sign, so the water extends further from the dam.
  EXPECT_NEAR(waters[1].level[0][0], 34.0, 1e-12);
  EXPECT_NEAR(waters[1].level[1][0], 36.5, 1e-12);
}

/// At its upright sides a model is cut off: a head there is that of water in the ground beyond.
TEST(OutsideWater, StandsOverLevelFacesAndNotBesideUprightOnes) {
  Scene scene = dam_scene();
  const Case<2> c = testing::unit_square_case();
  Mesh<2> mesh = c.mesh;
  mesh.boundaries.push_back({"left", {{0, 3}, {3, 6}}});
  mesh.boundaries.push_back({"right", {{5, 2}, {8, 5}}});
  scene.boundaries = {head_on("left", 0.75), head_on("right", 1.25), head_on("top", 1.5),
                      head_on("bottom", 0.5)};
  const auto waters = outside_water(mesh, scene, 0.0, 0.1);
  ASSERT_EQ(waters.size(), 1U) << "below the model and beside it no water can be drawn";
  EXPECT_EQ(waters[0].boundary, "top");
  EXPECT_NEAR(sum_of_areas(waters[0]), 0.5, 1e-12);
}

TEST(OutsideWater, FollowsTheTimeAndGravityAndLeavesWellsOut) {
  Scene scene = dam_scene();
  scene.boundaries[0] = head_on("upstream", TimeFunction({{0.0, -1.0}, {10.0, 7.0}}));
  scene.boundaries[1].key = "well[0]";
  const Mesh<2> mesh = dam_mesh(10, 8);
  EXPECT_TRUE(outside_water(mesh, scene, 0.0, 1.0).empty());
  ASSERT_EQ(outside_water(mesh, scene, 5.0, 1.0).size(), 1U);
  EXPECT_NEAR(outside_water(mesh, scene, 5.0, 1.0)[0].head, 3.0, 1e-12);
  scene.gravity = {};
  EXPECT_TRUE(outside_water(mesh, scene, 5.0, 1.0).empty());
}

TEST(Contours, AreTheStraightLinesOfALinearField) {
  const Mesh<2> mesh = dam_mesh(9, 7);
  std::vector<double> field;
  for (const Vector<2>& x : mesh.nodes) field.push_back(x[0] + 3.0 * x[1]);
  const auto lines = contour_lines(mesh, field, 25.0);
  ASSERT_EQ(lines.size(), 1U);
  for (const Vector<2>& x : lines[0]) EXPECT_NEAR(x[0] + 3.0 * x[1], 25.0, 1e-12);
  // From the bottom, x = 25, to the upstream slope, x = 2 y: y = 5.
  const Vector<2> bottom(25.0, 0.0);
  const Vector<2> slope(10.0, 5.0);
  EXPECT_NEAR(length(lines[0]), (bottom - slope).norm(), 1e-12);
  EXPECT_NEAR((place_on(lines[0], 0.5) - 0.5 * (bottom + slope)).norm(), 0.0, 1e-12);
  EXPECT_TRUE(contour_lines(mesh, field, -1.0).empty());
}

TEST(Contours, LeaveOutWhatIsNotFinite) {
  const Mesh<2> mesh = dam_mesh(9, 7);
  std::vector<double> field;
  for (const Vector<2>& x : mesh.nodes) field.push_back(x[0] > 20.0 ? HUGE_VAL : x[0] + x[1]);
  for (const Polyline& line : contour_lines(mesh, field, 18.0)) {
    for (const Vector<2>& x : line) EXPECT_NEAR(x[0] + x[1], 18.0, 1e-12);
  }
}

TEST(Contours, ThatCloseAreOneLine) {
  const Mesh<2> mesh = dam_mesh(40, 20);
  std::vector<double> field;
  for (const Vector<2>& x : mesh.nodes) field.push_back((x - Vector<2>(18.0, 3.0)).norm());
  const auto lines = contour_lines(mesh, field, 2.5);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ((lines[0].front() - lines[0].back()).norm(), 0.0);
  EXPECT_NEAR(length(lines[0]), 2.0 * std::numbers::pi * 2.5, 0.2);
}

TEST(Contours, BandsFillATriangleWithoutGaps) {
  const std::array<Vector<2>, 3> corners{Vector<2>(0.0, 0.0), Vector<2>(4.0, 0.0),
                                         Vector<2>(0.0, 3.0)};
  const std::array<double, 3> values{0.0, 4.0, 9.0};
  const auto area = [](const Polyline& p) {
    double twice = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vector<2>& y = p[(i + 1) % p.size()];
      twice += p[i][0] * y[1] - p[i][1] * y[0];
    }
    return 0.5 * twice;
  };
  double sum = 0.0;
  for (double low = -2.0; low < 10.0; low += 2.0) {
    sum += area(band_in_triangle(corners, values, low, low + 2.0));
  }
  EXPECT_NEAR(sum, 6.0, 1e-12);
  // The corner at 9 cut at 7: the shares of both sides are 2/9 and 2/5.
  EXPECT_NEAR(area(band_in_triangle(corners, values, 7.0, 10.0)), 6.0 * 2.0 / 9.0 * 2.0 / 5.0,
              1e-12);
  EXPECT_TRUE(band_in_triangle(corners, values, 9.5, 10.0).empty());
}

TEST(SeepageMap, LevelsAreRoundAndEncloseTheValues) {
  const std::vector<double> levels = band_levels(1.03, 5.9);
  EXPECT_LE(levels.front(), 1.03);
  EXPECT_GE(levels.back(), 5.9);
  EXPECT_GT(levels[1], 1.03);
  EXPECT_GE(levels.size(), 6U);
  EXPECT_NEAR(std::remainder(levels[1], 0.5), 0.0, 1e-12);
  // In water at rest no lines follow the round-off.
  EXPECT_EQ(band_levels(2.0, 2.0 + 1e-13).size(), 2U);
}

TEST(SeepageMap, HasItsTextsLinesAndColours) {
  const ScratchFolder scratch;
  const SeepageMap map = dam_map(60, 16);
  draw_seepage_map(map, scratch / "head.svg");
  const std::string svg = file_text(scratch / "head.svg");
  EXPECT_EQ(svg.find("<image"), std::string::npos);
  for (const auto* text : {"dam, t = 0 s", "head h (m)", "x (m)", "y (m)", ">6 m<", ">1 m<",
                           "equipotential, head in m", "phreatic line, p = 0",
                           "water level outside, with its head", ">4<", ">2.5<"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  // The bands are paths: the water's tint, and the highest band's colour.
  EXPECT_NE(svg.find("fill=\"rgb(232,245,255)\""), std::string::npos);
  EXPECT_GT(svg.size(), 200000U);
  draw_seepage_map(map, scratch / "head.png");
  const Pixels pixels(scratch / "head.png");
  // Pixels per metre; the downstream level ends 0.5 m outside the model, and 102 pixels below the
  // axes are those of the bar.
  const double scale = 1000.0 / 36.5;
  const auto at = [&](double x, double y) {
    return pixels.at(Eigen::Vector2d{110.0 + scale * x, 90.0 + 90.0 + 102.0 + scale * y});
  };
  const auto grey = [](const std::array<int, 3>& c) {
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
  };
  // Water outside is light; inside, the head falls from bright to dark, also in print without
  // colour.
  testing::expect_color(at(2.0, 4.0), {0.91, 0.96, 1.0}, "water upstream");
  EXPECT_GT(grey(at(8.0, 1.0)), grey(at(21.0, 0.7)) + 40.0);
  EXPECT_GT(grey(at(21.0, 0.7)), grey(at(33.8, 0.3)) + 20.0);
  // On the phreatic line, at half the way.
  const double middle = std::sqrt(36.0 - 35.0 * 0.5);
  testing::expect_color(at(23.0, middle), {0.0, 0.27, 0.53}, "phreatic line");
}

TEST(SeepageMap, OfSaturationIsDarkWhereItIsWet) {
  const ScratchFolder scratch;
  SeepageMap map = dam_map(30, 8);
  map.label = "saturation S (-)";
  for (int e = 0; e < map.mesh.element_count(); ++e) {
    map.saturation.push_back(element_centroid(map.mesh, e)[1] < 4.0 ? 1.0 : 0.32);
  }
  draw_seepage_map(map, scratch / "saturation.svg");
  const std::string svg = file_text(scratch / "saturation.svg");
  EXPECT_NE(svg.find("saturation S (-)"), std::string::npos);
  EXPECT_EQ(svg.find("equipotential"), std::string::npos);
  draw_seepage_map(map, scratch / "saturation.png");
  const Pixels pixels(scratch / "saturation.png");
  const double scale = 1000.0 / 36.5;
  const auto at = [&](double x, double y) {
    return pixels.at(Eigen::Vector2d{110.0 + scale * x, 90.0 + 60.0 + 102.0 + scale * y});
  };
  EXPECT_LT(at(18.0, 1.0)[1] + 100, at(18.0, 7.0)[1]);
}

/// A run under gravity, with heads from its node pressures.
ResultsReader heavy_run(const ScratchFolder& scratch, bool with_saturation) {
  Case<2> c = testing::unit_square_case();
  c.document = parse_scene("gravity = [0.0, -9.81]\ninitial.flow = \"steady\"\n" + c.document.text,
                           "heavy.toml");
  {
    ResultsWriter<2> writer(scratch / "run.results", c);
    for (const double t : {0.0, 10.0}) {
      Snapshot s = testing::linear_snapshot(c, t, 0);
      Field pressure{"pressure", "Pa", 1, {}};
      for (const Vector<2>& x : c.mesh.nodes) pressure.values.push_back(9810.0 * (2.0 + t - x[1]));
      s.node.push_back(pressure);
      Field saturation{"saturation", "1", 1, std::vector<double>(c.mesh.elements.size(), 0.5)};
      if (with_saturation) s.cell.push_back(saturation);
      writer.write_snapshot(s);
    }
  }
  return ResultsReader(scratch / "run.results");
}

TEST(SeepageMap, TakesHeadsOfTheSnapshotAskedFor) {
  const ScratchFolder scratch;
  const ResultsReader run = heavy_run(scratch, true);
  for (const double head : head_map(run, {}).head) EXPECT_NEAR(head, 12.0, 1e-12);
  const SeepageMap early = head_map(run, 2.0);
  for (const double head : early.head) EXPECT_NEAR(head, 2.0, 1e-12);
  EXPECT_EQ(early.title, "Head, 0 s (snapshot nearest to 2 s)");
  EXPECT_EQ(saturation_map(run, {}).saturation.front(), 0.5);
  draw_figure("head", {run}, scratch / "head.png", {2.0, ""});
  EXPECT_GT(Pixels(scratch / "head.png").inked(), 8000);
}

TEST(SeepageMap, TitlesHaveTheUnitThatFitsTheRun) {
  const ScratchFolder scratch;
  const Case<2> c = testing::unit_square_case();
  {
    ResultsWriter<2> writer(scratch / "run.results", c);
    for (const double t : {0.0, 864000.0}) writer.write_snapshot(testing::linear_snapshot(c, t, 0));
  }
  const ResultsReader run(scratch / "run.results");
  EXPECT_EQ(snapshot_title(run, 1, {}, "Head"), "Head, 10 d");
  EXPECT_EQ(snapshot_title(run, 0, 43200.0, "Head"), "Head, 0 d (snapshot nearest to 12 h)");
}

TEST(SeepageMap, HasNoHeadsOfAir) {
  const ScratchFolder scratch;
  const Case<2> c = testing::open_above_case(0.2);
  {
    ResultsWriter<2> writer(scratch / "run.results", c);
    for (const double share : {0.01, 1.0}) {
      Snapshot s = testing::linear_snapshot(c, share, 0);
      Field pressure{"pressure", "Pa", 1, {}};
      for (const Vector<2>& x : c.mesh.nodes) {
        const double head = x[1] > 0.75 ? 50.0 : 2.0 + x[0];
        pressure.values.push_back(9810.0 * (head - x[1]));
      }
      s.node.push_back(pressure);
      s.cell.push_back({"saturation", "1", 1, {1, 1, 1, 1, share, share, share, share}});
      // Soil has moved into the last element, and hardly any into the one before.
      for (Field& field : s.cell) {
        if (field.name == "porosity") field.values = {0.3, 0.3, 0.3, 0.3, 1, 1, 0.9, 0.4};
      }
      writer.write_snapshot(s);
    }
  }
  const ResultsReader run(scratch / "run.results");
  SeepageMap map = head_map(run, 0.01);
  EXPECT_EQ(map.air, (std::vector<bool>{false, false, false, false, true, true, true, false}));
  EXPECT_EQ(drawn_mesh(map).element_count(), 5);
  EXPECT_EQ(head_map(run, 1.0).air, std::vector<bool>(8, false)) << "free water has a head";
  map.air.back() = true;
  EXPECT_NEAR(head_range(map)[0], 2.0, 1e-12);
  EXPECT_NEAR(head_range(map)[1], 3.0, 1e-12);
  draw_seepage_map(map, scratch / "head.png");
  const Pixels pixels(scratch / "head.png");
  const auto at = [&](double x, double y) {
    const double scale = 800.0;
    const auto color = pixels.at(Eigen::Vector2d{110.0 + scale * x, 90.0 + 30.0 + scale * y});
    return color[0] + color[1] + color[2];
  };
  EXPECT_EQ(at(0.33, 0.77), 3 * 255) << "air is left white";
  EXPECT_LT(at(0.33, 0.37), 700);
  RenderRequest request;
  request.field = "head";
  request.time = 0.01;
  request.output = scratch / "rendered.png";
  render(run, request);
  const Pixels rendered(request.output);
  const auto inked = [&](double x, double y) {
    return rendered.at(Eigen::Vector2d{110.0 + 800.0 * x, 90.0 + 800.0 * y})[0] < 255;
  };
  EXPECT_FALSE(inked(0.33, 0.77)) << "air is left white";
  EXPECT_TRUE(inked(0.33, 0.37));
}

std::string refusal(const auto& body) {
  try {
    body();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SeepageMap, RefusesWhatItCannotDraw) {
  const ScratchFolder scratch;
  const ResultsReader run = heavy_run(scratch, false);
  EXPECT_NE(refusal([&] { draw_figure("saturation", {run}, scratch / "a.png"); })
                .find("in which every soil is saturated; expected soil.NAME.retention in the "
                      "scene, such as retention"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              draw_figure("head", {run, run}, scratch / "a.png");
            }).find("RESULTS: got 2 folders; expected one"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              draw_figure("porosity", {run}, scratch / "a.png", {1.0, ""});
            })
                .find("--time: got it with the figure \"porosity\"; expected it with \"flownet\", "
                      "\"head\" or \"saturation\""),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              draw_figure("head", {run}, scratch / "a.png", {HUGE_VAL, ""});
            }).find("expected a time from 0 to 10 s, the first and last"),
            std::string::npos);
}

}  // namespace seepage_map_test
}  // namespace suffuse

#include "figures/model_sketch.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "figures/figures.hpp"
#include "post/picture_pixels.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace model_sketch_test {

using testing::file_text;
using testing::ScratchFolder;

void expect_texts(const std::string& svg, const std::vector<std::string>& texts) {
  for (const auto& text : texts) EXPECT_NE(svg.find(text), std::string::npos) << text;
}

TEST(ModelSketch, DoublePointModel) {
  const ScratchFolder scratch;
  testing::double_point::write_results(scratch / "run.results");
  draw_figure("model", {ResultsReader(scratch / "run.results")}, scratch / "model.svg");
  const std::string svg = file_text(scratch / "model.svg");
  EXPECT_NE(svg.find("<svg "), std::string::npos);
  EXPECT_EQ(svg.find("<image"), std::string::npos);
  expect_texts(
      svg, {"two-phase, double-point model", "inflow: Darcy flux 0.02 m/s, c = 0",
            "outflow: pressure 0 Pa", "left, right: impervious", "16 solid points",
            "66 liquid points", "24 elements", "inflow: free water", "buffer: soil, does not erode",
            "specimen: soil, erodes (constant law)", "x (m)", "y (m)", ">-1<", ">2<"});
}

TEST(ModelSketch, SinglePointModel) {
  const ScratchFolder scratch;
  testing::write_synthetic_results(scratch / "run.results");
  draw_figure("model", {ResultsReader(scratch / "run.results")}, scratch / "model.svg");
  expect_texts(file_text(scratch / "model.svg"),
               {"synthetic, single-point model", "top: pressure 6000 Pa, c = 0",
                "bottom: pressure 0 Pa", "unnamed: impervious", "8 material points"});
}

TEST(ModelSketch, ValuesThatChangeAreShownFromLeastToMost) {
  const ScratchFolder scratch;
  Case<2> c = testing::unit_square_case();
  std::string text = c.document.text;
  const std::string top = "pressure = 6.0e3\nconcentration = 0.0";
  const std::string bottom = "pressure = 0.0";
  ASSERT_NE(text.find(top), std::string::npos);
  text.replace(text.find(bottom), bottom.size(), "darcy_flux = [[0, 0.01], [1, -0.02]]");
  text.replace(text.find(top), top.size(),
               "pressure = [[0, 0], [5, 6.0e3], [9, 100]]\nconcentration = [[0, 0.2], [1, 0.1]]");
  c.document = parse_scene(text, "changed.toml");
  { const ResultsWriter<2> writer(scratch / "run.results", c); }
  const auto boundaries = sketched_boundaries(ResultsReader(scratch / "run.results"));
  ASSERT_EQ(boundaries.size(), 3U);
  EXPECT_EQ(boundaries[1].label, "top: pressure 0 to 6000 Pa, c = 0.1 to 0.2");
  // Clean liquid enters for a while.
  EXPECT_EQ(boundaries[0].label, "bottom: Darcy flux -0.02 to 0.01 m/s, c = 0");
}

TEST(ModelSketch, NamesEveryConditionOfSeepage) {
  const Case<2> c = testing::unit_square_case();
  const auto label = [&](const std::function<void(BoundaryCondition&)>& set) {
    Scene scene;
    BoundaryCondition boundary;
    boundary.on = "top";
    set(boundary);
    scene.boundaries = {boundary};
    scene.walls = {{"bottom", 1e-6}};
    const auto boundaries = sketched_boundaries(c.mesh, scene);
    EXPECT_EQ(boundaries[0].label, "bottom: wall, conductance 1e-06 1/s");
    return boundaries[1].label;
  };
  const TimeFunction flood({{0.0, 2.0}, {9.0, 5.0}});
  EXPECT_EQ(label([&](BoundaryCondition& b) { b.head = flood; }), "top: head 2 to 5 m");
  EXPECT_EQ(label([](BoundaryCondition& b) { b.seepage_face = true; }), "top: seepage face");
  EXPECT_EQ(label([](BoundaryCondition& b) { b.rain = 1e-7; }), "top: rain 1e-07 m/s");
  EXPECT_EQ(label([](BoundaryCondition& b) { b.rate = -2e-4; }), "top: rate -2e-04 m3/s");
}

TEST(ModelSketch, NamesWhatHoldsAndLoadsSoilThatMoves) {
  const Case<2> c = testing::unit_square_case();
  Scene scene = testing::open_above_case(0.2).document.scene;
  ASSERT_TRUE(scene.moves());
  BoundaryCondition top;
  top.on = "top";
  top.head = 6.0;
  top.traction = VectorFunction{{{0.0, {0.0, 0.0, 0.0}}, {1.0, {0.0, -40e3, 0.0}}}, 2};
  BoundaryCondition bottom;
  bottom.on = "bottom";
  bottom.fix = Fixing::both;
  scene.boundaries = {top, bottom};
  const auto labels = [&] {
    std::vector<std::string> found;
    for (const auto& boundary : sketched_boundaries(c.mesh, scene)) found.push_back(boundary.label);
    return found;
  };
  EXPECT_EQ(labels(),
            (std::vector<std::string>{"top: head 6 m, traction 0, -40 to 0 kPa",
                                      "bottom: impervious, held", "unnamed: impervious"}));
  scene.boundaries[1].fix = Fixing::normal;
  EXPECT_EQ(labels()[1], "bottom: impervious, held along its normal");
  // Conditions on the soil say nothing where it stays.
  scene.soils.front().skeleton = {};
  EXPECT_EQ(labels()[1], "bottom, unnamed: impervious");
}

TEST(ModelSketch, AWallIsNoOuterEdge) {
  const Case<2> c = testing::unit_square_case();
  Scene scene;
  scene.walls = {{"bottom", 0.0}};
  const auto boundaries = sketched_boundaries(c.mesh, scene);
  ASSERT_EQ(boundaries.size(), 2U);
  EXPECT_EQ(boundaries[0].label, "bottom: impervious wall");
  EXPECT_EQ(boundaries[1].label, "top, unnamed: impervious");
}

TEST(ModelSketch, ARegionWithoutSoilHoldsWaterOrAir) {
  const auto label = [](double water_level) {
    const Case<2> c = testing::open_above_case(water_level);
    return region_label(c.mesh, c.document.scene, 1);
  };
  EXPECT_EQ(label(0.2), "free_above: air");
  EXPECT_EQ(label(0.7), "free_above: free water, air above it");
  EXPECT_EQ(label(1.0), "free_above: free water");
  Case<2> c = testing::open_above_case(0.2);
  c.document.scene.initial_flow = InitialFlow::steady;
  EXPECT_EQ(region_label(c.mesh, c.document.scene, 1), "free_above: air, or free water");
  c.document.scene.soils.front().retention.law = nullptr;
  EXPECT_EQ(region_label(c.mesh, c.document.scene, 1), "free_above: free water");
}

TEST(ModelSketch, EdgesOfTheMeshAreBlackAndPointsRedOrBlue) {
  const ScratchFolder scratch;
  testing::double_point::write_results(scratch / "run.results");
  draw_model_sketch(ResultsReader(scratch / "run.results"), scratch / "model.png");
  const testing::Pixels pixels(scratch / "model.png");
  const Case<2> c = testing::double_point::column();
  const double scale = 1100.0 / 3.0;
  const auto at = [&](const Vector<2>& x) {
    return pixels.at(Eigen::Vector2d{110.0 + scale * x[0], 90.0 + scale * (x[1] + 1.0)});
  };
  const auto solid = at(c.solid_points.position(c.mesh, 3));
  EXPECT_GT(solid[0], 180);
  EXPECT_LT(solid[1] + solid[2], 60);
  const auto liquid = at(c.liquid_points.position(c.mesh, 50));
  EXPECT_GT(liquid[2], 200);
  EXPECT_LT(liquid[0], 60);
  const auto edge = at({0.2, 1.0});  // between specimen and buffer
  EXPECT_LT(edge[0] + edge[1] + edge[2], 90);
  const auto water = at({0.3, 1.7});
  EXPECT_GT(water[2], 245);
  EXPECT_LT(water[0], 235);
}

TEST(ModelSketch, EveryOuterEdgeBelongsToOneBoundary) {
  const ScratchFolder scratch;
  testing::write_synthetic_results(scratch / "run.results");
  const auto boundaries = sketched_boundaries(ResultsReader(scratch / "run.results"));
  ASSERT_EQ(boundaries.size(), 3U);
  std::size_t edges = 0;
  for (const auto& boundary : boundaries) edges += boundary.faces.size();
  EXPECT_EQ(edges, 8U);
  EXPECT_EQ(boundaries.back().label, "unnamed: impervious");
}

}  // namespace model_sketch_test
}  // namespace suffuse

#include "model_sketch.hpp"

#include <gtest/gtest.h>

#include "figures.hpp"
#include "post/picture_pixels.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace {

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
  for (const auto& boundary : boundaries) edges += boundary.edges.size();
  EXPECT_EQ(edges, 8U);
  EXPECT_EQ(boundaries.back().label, "unnamed: impervious");
}

}  // namespace
}  // namespace suffuse

#include "figures/gradation_figure.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/errors.hpp"
#include "figures/figures.hpp"
#include "post/picture_pixels.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace gradation_figure_test {

using testing::file_text;
using testing::Pixels;
using testing::ScratchFolder;

/// A run whose scene has these gradations, as `--set` gives them.
ResultsReader run_with(const ScratchFolder& scratch, const std::string& name,
                       const std::vector<std::string>& changes) {
  Case<2> c = testing::unit_square_case(name);
  c.document = parse_scene(c.document.text, c.document.path, changes);
  const std::string folder = scratch / (name + ".results");
  {
    ResultsWriter<2> writer(folder, c);
    testing::write_rows(writer, 10.0, [](double t) { return 0.3 + 1e-4 * t; });
    writer.write_run_info([] {
      RunInfo info;
      info.status = "done";
      return info;
    }());
  }
  return ResultsReader(folder);
}

const std::string gap = "soil.specimen.gradation=[[0.1,0],[0.6,15],[2.4,17.1],[10,100]]";

std::string like(const std::string& name, const std::string& gradation) {
  return "soil." + name + "={like=\"specimen\", erosion={law=\"none\"}, gradation=" + gradation +
         "}";
}

const std::vector<std::string> three_soils{
    gap, like("core", "[[0.002,22],[0.02,60],[0.06,80],[0.2,100]]"),
    like("filter", "[[0.2,0],[1,20],[4,60],[16,100]]")};

TEST(GradationFigure, draws_points_and_marks_the_fines) {
  const ScratchFolder scratch;
  const Chart chart = gradation_chart({run_with(scratch, "dam", three_soils)});
  ASSERT_EQ(chart.curves.size(), 3U);
  EXPECT_TRUE(chart.logarithmic_x);
  EXPECT_EQ(chart.x_label, "grain size d (mm)");
  EXPECT_EQ(chart.y_label, "finer than d by mass, F (%)");
  const Curve& specimen = chart.curves[0];
  EXPECT_EQ(specimen.label, "specimen: F* = 15 % at 0.6 mm, H/F = 0.14");
  EXPECT_EQ(specimen.x, (std::vector{0.1, 0.6, 2.4, 10.0}));
  EXPECT_EQ(specimen.y, (std::vector{0.0, 15.0, 17.1, 100.0}));
  ASSERT_EQ(specimen.marked.size(), 1U);
  EXPECT_EQ(specimen.x[specimen.marked[0]], 0.6);
  EXPECT_TRUE(specimen.has_line());
  // The search ends at 30 % or 20 %, which lies between points of the curve.
  const Curve& filter = chart.curves[2];
  ASSERT_EQ(filter.marked.size(), 1U);
  EXPECT_TRUE(std::ranges::is_sorted(filter.x));
  EXPECT_TRUE(std::ranges::is_sorted(filter.y));
  // The core starts at 22 %: no F*, no marker.
  const Curve& core = chart.curves[1];
  EXPECT_EQ(core.label, "core");
  EXPECT_FALSE(core.markers);
  EXPECT_EQ(core.x.size(), 4U);
  // Soils can be told apart without colours.
  EXPECT_NE(specimen.dash, core.dash);
  EXPECT_NE(specimen.dash, filter.dash);
  EXPECT_NE(core.dash, filter.dash);
}

TEST(GradationFigure, has_a_table_of_the_verdicts) {
  const ScratchFolder scratch;
  const Chart chart = gradation_chart({run_with(scratch, "dam", three_soils)});
  const ChartTable expected{{"internal stability", "specimen", "core", "filter"},
                            {"Kezdi (1979)", "unstable", "stable above 25.9 %", "stable"},
                            {"Kenney and Lau (1986)", "unstable", "cannot be told", "stable"},
                            {"Li and Fannin (2008)", "unstable", "stable above 22 %", "stable"},
                            {"Burenkova (1993)", "unstable", "cannot be told", "stable"},
                            {"Wan and Fell (2008)", "unstable", "cannot be told", "stable"}};
  ASSERT_EQ(chart.table.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(chart.table[i], expected[i]);
}

/// A table of many columns would be wider than the chart.
TEST(GradationFigure, has_a_row_for_each_of_many_soils) {
  const ScratchFolder scratch;
  std::vector<std::string> soils{gap};
  for (const auto* name : {"a", "b", "c", "d", "e"}) {
    soils.push_back(like(name, "[[0.2,0],[1,20],[4,60],[16,100]]"));
  }
  const Chart chart = gradation_chart({run_with(scratch, "layers", soils)});
  ASSERT_EQ(chart.table.size(), 7U);
  EXPECT_EQ(chart.table[0],
            (std::vector<std::string>{"internal stability", "Kezdi (1979)", "Kenney and Lau (1986)",
                                      "Li and Fannin (2008)", "Burenkova (1993)",
                                      "Wan and Fell (2008)"}));
  EXPECT_EQ(chart.table[1][0], "specimen");
  EXPECT_EQ(chart.table[1][3], "unstable");
  EXPECT_EQ(chart.table[6][0], "e");
  EXPECT_EQ(chart.table[6][3], "stable");
}

TEST(GradationFigure, draws_equal_soils_of_several_runs_once) {
  const ScratchFolder scratch;
  const ResultsReader a = run_with(scratch, "a", {gap});
  const ResultsReader b = run_with(scratch, "b", {gap});
  const ResultsReader c =
      run_with(scratch, "c", {"soil.specimen.gradation=[[1,0],[2,50],[4,100]]"});
  EXPECT_EQ(gradation_chart({a, b}).curves.size(), 1U);
  const Chart chart = gradation_chart({a, b, c});
  ASSERT_EQ(chart.curves.size(), 2U);
  EXPECT_EQ(chart.curves[0].label.find("a: specimen: F* = 15 %"), 0U) << chart.curves[0].label;
  EXPECT_EQ(chart.curves[1].label.find("c: specimen: F* = 30 %"), 0U) << chart.curves[1].label;
}

TEST(GradationFigure, needs_a_gradation) {
  const ScratchFolder scratch;
  const ResultsReader run = run_with(scratch, "plain", {});
  try {
    draw_figure("gradation", {run}, scratch / "a.png");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(),
              run.folder() +
                  ": no soil of its scene has a gradation; expected soil.NAME.gradation in the "
                  "scene, such as gradation = [[0.1, 0], [1.0, 60], [4.0, 100]]");
  }
}

/// A straight line over log d from corner to corner of the axes goes through their middle.
TEST(GradationFigure, has_sizes_on_a_logarithmic_axis) {
  const ScratchFolder scratch;
  const ResultsReader run =
      run_with(scratch, "line", {"soil.specimen.gradation=[[0.1,0],[1,50],[10,100]]"});
  draw_figure("gradation", {run}, scratch / "figure.png");
  const Pixels pixels(scratch / "figure.png");
  // The axes' rectangle is 720 by 630 pixels from (120, 90) on.
  for (const double share : {0.25, 0.5, 0.75}) {
    int darkest = 255;
    for (int step = -2; step <= 2; ++step) {
      const double x = 120.0 + 720.0 * (0.5 + (share - 0.5) / 1.05);
      const double y = 90.0 + 630.0 * (0.5 + (share - 0.5) / 1.05) + step;
      darkest = std::min(darkest, pixels.at({x, y})[0]);
    }
    EXPECT_LT(darkest, 100) << share;
  }
}

TEST(GradationFigure, is_drawn_with_its_texts) {
  const ScratchFolder scratch;
  const std::vector<ResultsReader> runs{run_with(scratch, "dam", three_soils)};
  draw_figure("gradation", runs, scratch / "figure.svg");
  const std::string svg = file_text(scratch / "figure.svg");
  for (const auto* text :
       {"Gradation", "grain size d (mm)", "finer than d by mass, F (%)", ">0.01<", ">10<", ">100<",
        "specimen: F* = 15 % at 0.6 mm, H/F = 0.14", "internal stability", "Kenney and Lau (1986)",
        "cannot be told", "stable above 22 %"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  draw_figure("gradation", runs, scratch / "figure.png");
  const Pixels pixels(scratch / "figure.png");
  EXPECT_GE(pixels.width(), 1200);
  EXPECT_EQ(pixels.height(), 800);
  EXPECT_GT(pixels.inked(), 8000);
}

}  // namespace gradation_figure_test
}  // namespace suffuse

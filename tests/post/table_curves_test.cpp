/// The figures "curves" and "profile", and axes of choice.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "common/errors.hpp"
#include "figures/axes.hpp"
#include "figures/figures.hpp"
#include "post/picture_pixels.hpp"
#include "post/synthetic_results.hpp"
#include "report/report.hpp"

namespace suffuse {
namespace table_curves_test {

using testing::file_text;
using testing::linear_porosity;
using testing::ScratchFolder;
using testing::write_synthetic_results;

class TableCurves : public ::testing::Test {
 protected:
  TableCurves() {
    write_synthetic_results(scratch_ / "a.results", "a");
    write_synthetic_results(scratch_ / "b.results", "b", 2e-3);
  }
  [[nodiscard]] std::vector<ResultsReader> run() const {
    return {ResultsReader(scratch_ / "a.results")};
  }
  [[nodiscard]] std::vector<ResultsReader> runs() const {
    return {ResultsReader(scratch_ / "a.results"), ResultsReader(scratch_ / "b.results")};
  }
  static std::string message(const std::vector<ResultsReader>& runs, const FigureOptions& options) {
    try {
      make_figure("curves", runs, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  ScratchFolder scratch_;
};

TEST_F(TableCurves, RunsInFoldersOfOneNameDiffer) {
  std::filesystem::create_directories(scratch_ / "c");
  write_synthetic_results(scratch_ / "c/a.results", "a", 2e-3);
  FigureOptions options;
  options.columns = {"porosity_mean"};
  const auto chart =
      make_figure("curves", {run()[0], ResultsReader(scratch_ / "c/a.results")}, options);
  const Curve& first = chart[0].curves[0];
  const Curve& second = chart[0].curves[1];
  EXPECT_EQ(second.label, "c/a");
  EXPECT_TRUE(first.label.ends_with("/a") && first.label != second.label) << first.label;
  EXPECT_NE(first.color, second.color);
  EXPECT_NE(first.dash, second.dash);
}

TEST_F(TableCurves, AnyColumnOfAnyTable) {
  FigureOptions options;
  options.columns = {"porosity_mean", "ledger.eroded", "boundaries.discharge"};
  const auto charts = make_figure("curves", run(), options);
  ASSERT_EQ(charts.size(), 3U);
  EXPECT_EQ(charts[0].curves[0].y, run()[0].history().column("porosity_mean"));
  EXPECT_EQ(charts[1].curves[0].y, run()[0].ledger().column("eroded"));
  EXPECT_EQ(charts[1].y_label, "eroded fines (kg/m)");
  ASSERT_EQ(charts[2].curves.size(), 2U);
  EXPECT_EQ(charts[2].curves[1].label, "bottom");
  EXPECT_EQ(charts[2].curves[1].y.back(), 0.005);
}

TEST_F(TableCurves, ARatioWithoutAValueIsLeftOut) {
  FigureOptions options;
  options.columns = {"conductivity_ratio"};
  const Curve curve = make_figure("curves", run(), options)[0].curves[0];
  const std::vector<double> t = run()[0].history().column("t");
  const std::vector<double> ratio = run()[0].history().column("conductivity_ratio");
  EXPECT_EQ(std::ranges::count(ratio, 0.0), 3);
  EXPECT_EQ(curve.x, std::vector<double>(t.begin() + 3, t.end()));
  EXPECT_EQ(curve.y, std::vector<double>(ratio.begin() + 3, ratio.end()));
}

TEST_F(TableCurves, OnePartOfATable) {
  FigureOptions options;
  options.columns = {"boundaries.liquid_out:bottom", "regions.eroded:specimen"};
  const auto charts = make_figure("curves", runs(), options);
  ASSERT_EQ(charts[0].curves.size(), 2U);
  EXPECT_EQ(charts[0].title, "Liquid that left: bottom");
  EXPECT_EQ(charts[0].curves[1].label, "b");
  EXPECT_EQ(charts[1].curves[1].y, runs()[1].region_ledgers().column("eroded"));
}

/// Of two boundaries one has a head outside: the other one has no level, which is 0 in its table.
TEST_F(TableCurves, BoundariesWithoutAHeadHaveNoLevel) {
  FigureOptions options;
  options.columns = {"boundaries.level"};
  EXPECT_NE(message(run(), options)
                .find("expected head of a [[boundary]] in the scene, such as head = 2.0"),
            std::string::npos);
  Case<2> c = testing::unit_square_case();
  std::string text = c.document.text;
  text.replace(text.find("pressure = 6.0e3"), 16, "head = 2.5");
  c.document = parse_scene(text, "heads.toml");
  {
    ResultsWriter<2> writer(scratch_ / "heads.results", c);
    for (const double t : {0.0, 1.0}) {
      const std::array<BoundaryRow, 2> rows{
          {{.t = t, .boundary = "top", .level = 2.5}, {.t = t, .boundary = "bottom"}}};
      writer.append_boundaries(rows);
    }
    writer.write_run_info(RunInfo{});
  }
  const std::vector<ResultsReader> heads{ResultsReader(scratch_ / "heads.results")};
  const Chart chart = make_figure("curves", heads, options)[0];
  ASSERT_EQ(chart.curves.size(), 1U);
  EXPECT_EQ(chart.curves[0].label, "top");
  EXPECT_EQ(chart.curves[0].y, (std::vector{2.5, 2.5}));
  options.columns = {"boundaries.level:bottom"};
  EXPECT_NE(message(heads, options).find("behind the colon one of \"top\""), std::string::npos);
  const std::string page = report_html(heads);
  const auto row = page.find("<tr><td>bottom</td>", page.find("<table class=\"boundaries\">"));
  EXPECT_NE(page.substr(row, page.find("</tr>", row) - row).find("<td class=\"empty\">-</td>"),
            std::string::npos);
}

TEST_F(TableCurves, AnotherColumnAlongXAndAxesOfChoice) {
  FigureOptions options;
  options.columns = {"eroded"};
  options.x = "porosity_mean";
  options.axes.log_y = true;
  options.axes.x_range = "0.3:0.35";
  const Chart chart = make_figure("curves", run(), options)[0];
  EXPECT_EQ(chart.x_label, "mean porosity (-)");
  EXPECT_TRUE(chart.logarithmic_y);
  EXPECT_EQ((*chart.x_range)[1], 0.35);
  // Eroded mass starts at zero, which has no logarithm: it is left out.
  draw_figure("curves", run(), scratch_ / "a.png", options);
}

TEST_F(TableCurves, TimeIsInTheUnitOfChoice) {
  FigureOptions options;
  options.axes.time_unit = "min";
  const Chart chart = make_figure("porosity", run(), options)[0];
  EXPECT_EQ(chart.x_label, "time (min)");
  EXPECT_EQ(chart.curves.back().x.back(), 2.0);
}

TEST_F(TableCurves, TimeIsInTheUnitThatFitsUnlessARangeIsGivenInSeconds) {
  Chart chart{"", seconds_label, "", {}};
  Curve curve;
  curve.x = {0.0, 22000.0};
  chart.curves.push_back(curve);
  Chart hours = chart;
  set_axes({}, "test", hours);
  EXPECT_EQ(hours.x_label, "time (h)");
  EXPECT_EQ(hours.curves[0].x[1], 22000.0 / 3600.0);
  AxisOptions options;
  options.x_range = "0:22000";
  set_axes(options, "test", chart);
  EXPECT_EQ(chart.x_label, seconds_label);
  EXPECT_EQ(chart.curves[0].x[1], 22000.0);
}

TEST_F(TableCurves, MeasuredTablesMayHaveAMarkAndBlankLines) {
  FigureOptions options;
  options.columns = {"porosity_mean"};
  options.measured = scratch_ / "measured.csv";
  std::ofstream(options.measured) << "\xEF\xBB\xBFrun,t,porosity_mean\n\nb,10,0.3\n\n";
  const auto chart = make_figure("curves", runs(), options).front();
  EXPECT_EQ(chart.curves.back().label, "b, measured");
  EXPECT_EQ(chart.curves.back().y, std::vector{0.3});
  std::ofstream(options.measured) << "t,porosity_mean,t\n0,0.3,1\n";
  EXPECT_NE(message(run(), options).find("several columns \"t\""), std::string::npos);
}

TEST_F(TableCurves, MeasuredPointsLieBesideThem) {
  const std::string path = scratch_ / "measured.csv";
  std::ofstream(path) << "t [min],porosity_mean\n1,0.36\n2,0.4\n";
  FigureOptions options;
  options.columns = {"porosity_mean"};
  options.measured = path;
  const Chart chart = make_figure("curves", run(), options)[0];
  EXPECT_EQ(chart.curves.back().label, "measured");
  EXPECT_EQ(chart.curves.back().x, (std::vector<double>{60.0, 120.0}));
  EXPECT_TRUE(chart.curves.back().markers);
  options.columns = {"flux_out"};
  EXPECT_NE(message(run(), options).find("--measured: got"), std::string::npos);
}

/// Columns of earlier versions are found by their present names, which messages suggest.
TEST_F(TableCurves, FinesThatLeftHaveANameOfTheirOwn) {
  const std::string path = scratch_ / "a.results/history.csv";
  std::string table = file_text(path);
  const std::vector<double> percent = run()[0].history().column("fines_out_percent");
  for (const auto& [before, now] : renamed_columns) {
    const std::string column = "," + std::string(now) + ",";
    const auto at = table.find(column);
    ASSERT_LT(at, table.find('\n'));
    table.replace(at + 1, now.size(), before);
  }
  std::ofstream(path) << table;
  EXPECT_EQ(run()[0].history().column("fines_out_percent"), percent);
  FigureOptions options;
  options.columns = {"fines_out_percent"};
  EXPECT_EQ(make_figure("curves", run(), options)[0].y_label,
            "fines that left, of those at the start (%)");
  for (const auto& [before, now] : renamed_columns) {
    options.columns = {"history." + std::string(before)};
    EXPECT_NE(message(run(), options).find("did you mean " + std::string(now) + "?"),
              std::string::npos);
  }
  options.columns = {"flux_out"};
  options.x = "fines_left";
  EXPECT_NE(message(run(), options).find("did you mean fines_out?"), std::string::npos);
  options = {};
  options.columns = {"fines_out"};
  options.measured = scratch_ / "measured.csv";
  std::ofstream(options.measured) << "t,fines_left\n0,0\n";
  EXPECT_NE(message(run(), options).find("a column fines_left; expected fines_out, the name of"),
            std::string::npos);
}

TEST_F(TableCurves, WhatIsNotThereIsRefused) {
  FigureOptions options;
  EXPECT_NE(message(run(), options).find("COLUMN: got none"), std::string::npos);
  options.columns = {"porosity_meen"};
  EXPECT_NE(message(run(), options).find("did you mean porosity_mean?"), std::string::npos);
  options.columns = {"ledgers.eroded"};
  EXPECT_NE(message(run(), options).find("did you mean ledger?"), std::string::npos);
  options.columns = {"boundaries.discharge:topp"};
  EXPECT_NE(message(run(), options).find("did you mean top?"), std::string::npos);
  options.columns = {"probes.head"};
  const std::string folder = scratch_ / "a.results";
  EXPECT_EQ(message(run(), options), "suffuse-post figure curves: COLUMN: got \"probes.head\" of " +
                                         folder +
                                         "; expected [[output.probe]] in the scene, such as at = "
                                         "[0.5, 0.5]");
  for (const char* column : {"sections.discharge", "volume"}) {
    options.columns = {column};
    EXPECT_NE(message(run(), options)
                  .find("expected [[output.section]] in the scene, such as from = [0.0, 0.5] and "
                        "to = [1.0, 0.5]"),
              std::string::npos);
  }
  options.columns = {"eroded"};
  options.axes.y_range = "2:1";
  EXPECT_NE(message(run(), options).find("--y-range: got \"2:1\"; expected LO:HI"),
            std::string::npos);
  options.axes.y_range = "";
  options.line = "0,0:1,1";
  EXPECT_NE(message(run(), options)
                .find("--line: got it with the figure \"curves\"; expected it with "
                      "\"profile\""),
            std::string::npos);
}

TEST_F(TableCurves, ProfileAlongALineAtSeveralTimes) {
  FigureOptions options;
  options.line = "0.25,0.1:0.25,0.9";
  options.fields = "porosity,darcy_flux";
  options.times = "0,10";
  options.count = 5;
  const auto charts = make_figure("profile", runs(), options);
  ASSERT_EQ(charts.size(), 3U);
  EXPECT_EQ(charts[1].y_label, "Darcy flux along x (m/s)");
  EXPECT_EQ(charts[1].title, "Darcy flux along x from (0.25, 0.1) to (0.25, 0.9) m");
  ASSERT_EQ(charts[0].curves.size(), 4U);
  EXPECT_EQ(charts[0].curves[3].label, "b, t = 10 s");
  EXPECT_NEAR(charts[0].curves[1].x[2], 0.4, 1e-15);
  EXPECT_NEAR(charts[0].curves[1].y[2], linear_porosity(0.25, 0.5, 10.0), 1e-14);
  EXPECT_EQ(charts[2].curves[0].y[0], -1.0);
  options.change = true;
  EXPECT_NEAR(make_figure("profile", run(), options)[0].curves[1].y[2], 1e-2 * 1.25, 1e-14);
}

}  // namespace table_curves_test
}  // namespace suffuse

#include "figures/sweep_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/errors.hpp"
#include "figures/sweep_axes.hpp"
#include "post/picture_pixels.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace sweep_figures_test {

using testing::file_text;
using testing::Pixels;
using testing::ScratchFolder;

void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
}

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

const std::string rate = "soil.specimen.erosion.rate";

/// Run i of `count` has the key `x(i)`, and loses y = i + 1 kg. One more run was refused.
template <class X>
SweepTable sweep_of(const ScratchFolder& scratch, int count, const X& x) {
  std::ostringstream text;
  text << "run," << rate << ",status,message,law,fines_lost\n";
  for (int i = 0; i < count; ++i)
    text << i << "," << x(i) << ",done,,first-order," << i + 1 << "\n";
  text << "9999,1e9,refused,\"got 1e9, expected less\",,\n";
  write_text(scratch / "sweep.csv", text.str());
  return read_sweep(scratch / "sweep.csv");
}

TEST(Quantile, OfAFewValuesByHand) {
  EXPECT_EQ(quantile({7.0}, 0.1), 7.0);
  EXPECT_EQ(quantile({1.0, 2.0, 4.0}, 0.0), 1.0);
  EXPECT_EQ(quantile({1.0, 2.0, 4.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({1.0, 2.0, 4.0}, 0.75), 3.0);
  EXPECT_EQ(quantile({1.0, 2.0, 4.0}, 1.0), 4.0);
}

TEST(SweepFigures, RunsThatShareAKeyAreOneGroup) {
  const ScratchFolder scratch;
  // y of x = 3: 1, 3, ... 21; of x = 5: 2, 4, ... 22.
  const auto sweep = sweep_of(scratch, 22, [](int i) { return i % 2 == 0 ? 3 : 5; });
  const Chart chart = over_key_charts(sweep, rate, {"fines_lost"}).front();
  ASSERT_EQ(chart.curves.size(), 3U);
  EXPECT_EQ(chart.curves[0].x, (std::vector{3.0, 5.0}));
  EXPECT_EQ(chart.curves[0].low, (std::vector{3.0, 4.0}));
  EXPECT_EQ(chart.curves[0].y, (std::vector{19.0, 20.0}));
  EXPECT_EQ(chart.curves[1].x.size(), 22U);
  EXPECT_EQ(chart.curves[1].label, "22 runs");
  EXPECT_EQ(chart.curves[2].y, (std::vector{11.0, 12.0}));
  EXPECT_EQ(chart.x_label, rate);
  EXPECT_EQ(chart.y_label, "fines lost (kg/m)");
  EXPECT_FALSE(chart.logarithmic_x);
}

TEST(SweepFigures, TheBandOfTwoGroupsIsDrawn) {
  const ScratchFolder scratch;
  const auto inked = [&](bool has_band) {
    Chart chart{"", "x", "y", {}};
    chart.extra_x = chart.extra_y = {0.0, 3.0};
    Curve band;
    band.x = {1.0, 2.0};
    band.y = {2.0, 2.0};
    band.low = {1.0, 1.0};
    band.color = {0.0, 0.5, 0.0};
    if (has_band) chart.curves.push_back(band);
    draw_charts({chart}, scratch / "chart.png");
    return Pixels(scratch / "chart.png").inked();
  };
  // A third of the width and of the height of the axes.
  EXPECT_GT(inked(true) - inked(false), 40000);
}

TEST(SweepFigures, SampledKeysAreGroupedByTen) {
  const ScratchFolder scratch;
  // x descends, so that groups follow x and not the rows.
  const auto sweep = sweep_of(scratch, 100, [](int i) { return std::exp(0.1 * (100 - i)); });
  const Chart chart = over_key_charts(sweep, rate, {"fines_lost"}).front();
  ASSERT_EQ(chart.curves.size(), 3U);
  const Curve& band = chart.curves[0];
  ASSERT_EQ(band.x.size(), 10U);
  // The first group has the ten smallest x, of the last rows: y = 91 ... 100.
  EXPECT_DOUBLE_EQ(band.low.front(), 91.9);
  EXPECT_DOUBLE_EQ(band.y.front(), 99.1);
  EXPECT_DOUBLE_EQ(chart.curves[2].y.front(), 95.5);
  EXPECT_DOUBLE_EQ(chart.curves[2].y.back(), 5.5);
  EXPECT_TRUE(chart.logarithmic_x);
}

TEST(SweepFigures, FewRunsAreJoinedInOrder) {
  const ScratchFolder scratch;
  const auto sweep = sweep_of(scratch, 4, [](int i) { return std::vector{2, 8, 1, 4}[i]; });
  const Chart chart = over_key_charts(sweep, rate, {"fines_lost"}).front();
  ASSERT_EQ(chart.curves.size(), 2U);
  EXPECT_EQ(chart.curves[0].x, (std::vector{1.0, 2.0, 4.0, 8.0}));
  EXPECT_EQ(chart.curves[0].y, (std::vector{3.0, 1.0, 4.0, 2.0}));
  EXPECT_FALSE(chart.curves[0].is_band());
  EXPECT_TRUE(chart.curves[1].markers);
}

TEST(SweepFigures, EmptyCellsAreLeftOut) {
  const ScratchFolder scratch;
  const auto sweep = sweep_of(scratch, 4, [](int i) { return i == 1 ? "" : "2"; });
  const Chart chart = over_key_charts(sweep, rate, {"fines_lost"}).front();
  EXPECT_EQ(chart.curves[1].y, (std::vector{1.0, 3.0, 4.0}));
}

TEST(SweepFigures, DistributionOfEvenValues) {
  const ScratchFolder scratch;
  const auto sweep = sweep_of(scratch, 11, [](int i) { return i; });
  const Chart chart = distribution_charts(sweep, {"fines_lost"}).front();
  const Curve& runs = chart.curves.front();
  for (std::size_t i = 0; i < 11; ++i) {
    EXPECT_EQ(runs.x[i], static_cast<double>(i + 1));
    EXPECT_DOUBLE_EQ(runs.y[i], 10.0 * static_cast<double>(i));
  }
  EXPECT_EQ(chart.curves[1].x, (std::vector{2.0, 6.0, 10.0}));
  EXPECT_EQ(
      chart.table,
      (ChartTable{
          {"share of runs", "fines lost (kg/m)"}, {"10 %", "2"}, {"50 %", "6"}, {"90 %", "10"}}));
}

/// Three runs of constant laws, so that eroded masses are linear in time; the last two end as the
/// first does.
SweepTable three_runs(const ScratchFolder& scratch) {
  for (int i = 0; i < 3; ++i) {
    const std::string name = std::to_string(i);
    std::filesystem::create_directory(scratch / name);
    testing::write_synthetic_results(scratch / (name + "/" + name + ".results"), "run",
                                     1e-4 * (i + 1));
  }
  return sweep_of(scratch, 3, [](int i) { return i; });
}

TEST(SweepFigures, BandInTimeIsThatOfTheRows) {
  const ScratchFolder scratch;
  const auto sweep = three_runs(scratch);
  const Chart chart = over_time_charts(sweep, {"porosity_mean"}).front();
  ASSERT_EQ(chart.curves.size(), 5U);
  const Curve& band = chart.curves.front();
  ASSERT_TRUE(band.is_band());
  ASSERT_GT(band.x.size(), 100U);
  for (std::size_t i = 0; i < band.x.size(); ++i) {
    const double rise = 1e-4 * std::max(0.0, band.x[i] - 2.0);
    EXPECT_NEAR(band.low[i], 0.3 + 1.2 * rise, 1e-12);
    EXPECT_NEAR(chart.curves.back().y[i], 0.3 + 2.0 * rise, 1e-12);
    EXPECT_NEAR(band.y[i], 0.3 + 2.8 * rise, 1e-12);
  }
  EXPECT_EQ(chart.x_label, "time (s)");
  EXPECT_EQ(chart.y_label, "mean porosity (-)");
}

TEST(SweepFigures, BandsAreFilledUnderTheirCurves) {
  const ScratchFolder scratch;
  const auto sweep = three_runs(scratch);
  const auto charts = over_time_charts(sweep, {"porosity_mean"});
  ::testing::internal::CaptureStderr();
  draw_charts(charts, scratch / "band.png");
  draw_charts(charts, scratch / "band.svg");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  const Pixels pixels(scratch / "band.png");
  const Color color = charts.front().curves.front().color;
  int filled = 0;
  for (int y = 0; y < pixels.height(); ++y) {
    for (int x = 0; x < 840; ++x) {
      bool same = true;
      for (int k = 0; k < 3; ++k) {
        same = same && std::abs(pixels.at(x, y).at(k) - 255.0 * color.at(k)) < 4.0;
      }
      filled += same ? 1 : 0;
    }
  }
  // The band is a triangle from 2 s to 120 s, with a height of 1.6e-4 / s times the time; the axes
  // end at 120 s and go from 0.3 to about 0.34.
  EXPECT_GT(filled, 40000);
  EXPECT_LT(filled, 140000);
  const std::string svg = file_text(scratch / "band.svg");
  for (const auto* text : {"10 to 90 %", "3 runs", "median", "mean porosity (-)"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

TEST(SweepFigures, WrongColumnsAreNamed) {
  const ScratchFolder scratch;
  const auto sweep = three_runs(scratch);
  const std::string columns =
      "\"run\", \"" + rate + "\", \"status\", \"message\", \"law\" or \"fines_lost\"";
  EXPECT_EQ(message_of([&] { over_key_charts(sweep, "rates", {"fines_lost"}); }),
            "suffuse-post sweep: --x: got \"rates\"; expected a column of " + sweep.path + ": " +
                columns);
  EXPECT_EQ(message_of([&] { distribution_charts(sweep, {"fines_lots"}); }),
            "suffuse-post sweep: --y: got \"fines_lots\"; expected a column of " + sweep.path +
                ": " + columns + "; did you mean fines_lost?");
  EXPECT_EQ(message_of([&] { distribution_charts(sweep, {"law"}); }),
            "suffuse-post sweep: --y: got column \"law\" with \"first-order\"; expected a column "
            "of numbers");
  EXPECT_NE(message_of([&] {
              over_time_charts(sweep, {"porosity_means"});
            }).find("did you mean porosity_mean?"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              over_time_charts(sweep, {"fines_left_percent"});
            }).find("did you mean fines_out_percent?"),
            std::string::npos);
}

TEST(SweepTable, WrongTablesAreRefused) {
  const ScratchFolder scratch;
  const std::string path = scratch / "table.csv";
  const auto said = [&](const std::string& text) {
    write_text(path, text);
    return message_of([&] { read_sweep(path); });
  };
  EXPECT_EQ(said("a,b\n1,2\n"),
            path + ":1: got no columns run and status; expected the table of a sweep");
  EXPECT_EQ(said("run,status\n1\n"), path + ":2: got 1 columns; expected 2");
  EXPECT_EQ(said("run,status\n1,failed\n"),
            "suffuse-post sweep: TABLE: got " + path +
                " without a run that is done; expected one at least");
  EXPECT_EQ(message_of([&] { read_sweep(scratch / "none.csv"); }),
            (scratch / "none.csv") + ": cannot be read");
}

TEST(AxisText, KeysHaveTheUnitsOfTheScene) {
  EXPECT_EQ(axis_text("soil.foundation.conductivity"), "soil.foundation.conductivity (m/s)");
  EXPECT_EQ(axis_text("soil.\"a.b\".porosity"), "soil.\"a.b\".porosity (-)");
  EXPECT_EQ(axis_text("boundary[1].pressure"), "boundary[1].pressure (Pa)");
  EXPECT_EQ(axis_text("time.end"), "time.end (s)");
  EXPECT_EQ(axis_text("fines_lost_percent"), "fines lost, of those that could erode (%)");
  EXPECT_EQ(axis_text("law"), "law");
  EXPECT_EQ(axis_text("soil.specimen.erosion.rate"), "soil.specimen.erosion.rate");
  Scene scene = testing::unit_square_case("flux", "flux", 4.0).document.scene;
  EXPECT_EQ(axis_text("soil.specimen.erosion.rate", &scene), "soil.specimen.erosion.rate (1/m)");
  EXPECT_EQ(axis_text("soil.specimen.erosion.threshold", &scene),
            "soil.specimen.erosion.threshold (m/s)");
}

}  // namespace sweep_figures_test
}  // namespace suffuse

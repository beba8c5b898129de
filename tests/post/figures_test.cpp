#include "figures/figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "common/errors.hpp"
#include "drawing/ticks.hpp"
#include "figures/axes.hpp"
#include "figures/render.hpp"
#include "post/picture_pixels.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace figures_test {

using testing::file_text;
using testing::Pixels;
using testing::ScratchFolder;
using testing::write_synthetic_results;

std::vector<ResultsReader> two_runs(const ScratchFolder& scratch) {
  write_synthetic_results(scratch / "slow.results", "slow-run", 1e-3);
  write_synthetic_results(scratch / "fast.results", "fast-run", 5e-3);
  return {ResultsReader(scratch / "slow.results"), ResultsReader(scratch / "fast.results")};
}

TEST(Figures, PngIsDrawnWithoutADisplay) {
  const ScratchFolder scratch;
  const auto runs = two_runs(scratch);
  unsetenv("DISPLAY");
  for (const auto& name : figure_names()) {
    // These are tested in model_sketch_test, seepage_map_test, flow_net_test, gradation_figure_test
    // slip_figure_test and table_curves_test.
    const std::vector<std::string> elsewhere{"model",     "head",   "flownet", "saturation",
                                             "gradation", "curves", "profile", "slip"};
    if (std::ranges::find(elsewhere, name) != elsewhere.end()) continue;
    const std::string path = scratch / (name + ".png");
    ::testing::internal::CaptureStderr();
    draw_charts(make_figure(name, runs), path);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << name;
    const Pixels pixels(path);
    EXPECT_GE(pixels.width(), 1200) << name;
    EXPECT_EQ(pixels.height(), name == "comparison" ? 1600 : 800) << name;
    EXPECT_GT(pixels.inked(), 8000) << name;
    EXPECT_LT(pixels.inked(), 400000) << name;
    EXPECT_GT(pixels.color_count(), 20U) << name;
  }
}

TEST(Figures, PorositySvgHasItsTexts) {
  const ScratchFolder scratch;
  draw_figure("porosity", two_runs(scratch), scratch / "figure.svg");
  const std::string svg = file_text(scratch / "figure.svg");
  EXPECT_NE(svg.find("<svg "), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_EQ(svg.find("<image"), std::string::npos);
  for (const auto* text :
       {"Mean porosity of the soil", "time (s)", "porosity n_L (-)", "slow-run", "fast-run",
        "exact, constant law, 0.001 1/s", "exact, constant law, 0.005 1/s", ">120<", ">0.4<"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

// The pores of soil that air can enter hold an unknown mass of liquid.
TEST(Figures, SoilThatDrainsHasExactSolidAndErodedMassesAlone) {
  const ScratchFolder scratch;
  Case<2> c = testing::unit_square_case();
  c.document = parse_scene(c.document.text, "drains.toml",
                           {"time.scheme=implicit", "soil.specimen.retention.model=gardner",
                            "soil.specimen.retention.alpha=2"});
  {
    ResultsWriter<2> writer(scratch / "run.results", c);
    testing::write_rows(writer, 120.0, [](double t) { return 0.3 + 1e-4 * t; });
  }
  const Chart chart = make_figure("masses", {ResultsReader(scratch / "run.results")}).front();
  EXPECT_EQ(std::ranges::count(chart.curves, false, &Curve::markers), 2);
  for (const Curve& curve : chart.curves) {
    for (const double y : curve.y) EXPECT_TRUE(std::isfinite(y)) << curve.label;
  }
}

TEST(Figures, FluxLawHasNoExactCurveWithoutTheFlow) {
  const ScratchFolder scratch;
  const Case<2> c = testing::unit_square_case("flux", "flux", 4.0);
  {
    ResultsWriter<2> writer(scratch / "run.results", c);
    testing::write_rows(writer, 120.0, [](double t) { return 0.3 + 1e-4 * t; });
  }
  const std::vector<ResultsReader> runs{ResultsReader(scratch / "run.results")};
  for (const auto* name : {"porosity", "masses", "solid-mass"}) {
    for (const Chart& chart : make_figure(name, runs)) {
      for (const Curve& curve : chart.curves) {
        EXPECT_EQ(curve.label.find("exact"), std::string::npos) << curve.label;
        for (const double y : curve.y) EXPECT_TRUE(std::isfinite(y)) << curve.label;
      }
    }
  }
  // The outflow of the first-order law is exact at the steady flux of the heads, 6 kPa over 1 m.
  const auto charts = make_figure("outflow", runs);
  EXPECT_EQ(charts.front().curves.front().label.find("exact, flux law, 4 1/m, steady"), 0U)
      << charts.front().curves.front().label;
}

TEST(Figures, MassesSvgHasItsTexts) {
  const ScratchFolder scratch;
  draw_figure("masses", two_runs(scratch), scratch / "figure.svg");
  const std::string svg = file_text(scratch / "figure.svg");
  for (const auto* text : {"mass (kg per metre of thickness)", "slow-run: solid",
                           "slow-run: eroded", "slow-run: liquid", "fast-run: total"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

TEST(Figures, PdfIsAPdf) {
  const ScratchFolder scratch;
  draw_figure("porosity", two_runs(scratch), scratch / "figure.pdf");
  const std::string pdf = file_text(scratch / "figure.pdf");
  EXPECT_TRUE(pdf.starts_with("%PDF-"));
  for (const auto* text : {"(Mean porosity of the soil)", "(slow-run)", "%%EOF"}) {
    EXPECT_NE(pdf.find(text), std::string::npos) << text;
  }
}

/// The largest distance of markers from the line that fits best, relative to values above 1.
double distance_from_lines(const Chart& chart, const Curve& points) {
  double nearest = 1e300;
  for (const auto& line : chart.curves) {
    if (line.markers) continue;
    double distance = 0.0;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      const auto above = std::upper_bound(line.x.begin(), line.x.end() - 1, points.x[i]);
      const auto at = static_cast<std::size_t>(above - line.x.begin());
      const double share = (points.x[i] - line.x[at - 1]) / (line.x[at] - line.x[at - 1]);
      const double y = line.y[at - 1] + share * (line.y[at] - line.y[at - 1]);
      distance = std::max(distance, std::abs(y - points.y[i]) / std::max(1.0, points.y[i]));
    }
    nearest = std::min(nearest, distance);
  }
  return nearest;
}

// The rows of the synthetic runs follow Eq. 6, so every marker lies on an exact curve.
TEST(Figures, MarkersLieOnTheExactCurves) {
  const ScratchFolder scratch;
  for (const std::string name : {"porosity", "masses", "solid-mass"}) {
    const Chart chart = make_figure(name, two_runs(scratch)).front();
    std::size_t markers = 0;
    for (const auto& points : chart.curves) {
      if (!points.markers) continue;
      ASSERT_GT(points.marked.size(), 15U);
      EXPECT_LT(distance_from_lines(chart, points), 1e-12) << name << ": " << points.label;
      ++markers;
    }
    EXPECT_EQ(markers, name == "masses" ? 8U : 2U);
  }
}

std::vector<ResultsReader> both_formulations(const ScratchFolder& scratch) {
  write_synthetic_results(scratch / "single.results", "one-phase", 1e-3);
  testing::double_point::write_results(scratch / "double.results");
  return {ResultsReader(scratch / "single.results"), ResultsReader(scratch / "double.results")};
}

const Curve& curve_labelled(const Chart& chart, const std::string& label) {
  const auto found = std::ranges::find(chart.curves, label, &Curve::label);
  if (found == chart.curves.end()) throw std::out_of_range("no curve " + label);
  return *found;
}

TEST(Figures, FormulationsDifferInMarkerAndColour) {
  const ScratchFolder scratch;
  const auto runs = both_formulations(scratch);
  const Chart porosity = make_figure("porosity", runs).front();
  const Curve& single = curve_labelled(porosity, "one-phase, single-point");
  const Curve& two = curve_labelled(porosity, "two-phase, double-point");
  EXPECT_NE(single.marker, two.marker);
  EXPECT_GT(single.color[2], single.color[0]);  // cold
  EXPECT_GT(two.color[0], two.color[2]);        // warm
  // The colours do not depend on the order of the runs.
  const Chart reversed = make_figure("porosity", {runs[1], runs[0]}).front();
  EXPECT_EQ(curve_labelled(reversed, two.label).color, two.color);
  EXPECT_EQ(curve_labelled(reversed, single.label).marker, single.marker);
  const Chart masses = make_figure("masses", runs).front();
  EXPECT_FALSE(curve_labelled(masses, "one-phase, single-point: solid").hollow);
  EXPECT_TRUE(curve_labelled(masses, "two-phase, double-point: solid").hollow);
}

// Grains are in the soil, pending or out: the total counts every grain.
TEST(Figures, PendingGrainsCountInTheTotal) {
  const ScratchFolder scratch;
  const Chart chart = make_figure("masses", both_formulations(scratch)).front();
  for (const double mass : curve_labelled(chart, "two-phase, double-point: total").y) {
    EXPECT_NEAR(mass, 0.7 * 2700.0 + 300.0, 1e-9);
  }
}

// The outflow of the specimen is exact although buffers lie between it and the model's boundary.
TEST(Figures, OutflowIsThatOfTheSpecimen) {
  namespace dp = testing::double_point;
  const ScratchFolder scratch;
  dp::write_results(scratch / "double.results");
  const auto charts = make_figure("outflow", {ResultsReader(scratch / "double.results")});
  ASSERT_EQ(charts.size(), 2U);
  const std::string exact = "exact, constant law, 0.001 1/s, steady q = 0.02 m/s";
  const Curve& c = curve_labelled(charts[0], exact);
  const Curve& out = curve_labelled(charts[1], exact);
  for (std::size_t i = 0; i < c.x.size(); ++i) {
    if (c.x[i] < dp::start) continue;
    EXPECT_NEAR(c.y[i], dp::concentration_out(c.x[i]), 1e-10) << c.x[i];
    EXPECT_NEAR(out.y[i], dp::fines_out(c.x[i]), 1e-7) << out.x[i];
  }
  const Curve& computed = curve_labelled(charts[0], "two-phase");
  ASSERT_GE(computed.x.size(), 20U);
  // Means over a window are exact except at the bends at the start and where the front comes out.
  EXPECT_LT(distance_from_lines(charts[0], computed), 2e-3);
  for (std::size_t i = 0; i < computed.x.size(); ++i) {
    if (computed.x[i] < dp::front_time() + 3.0) continue;
    EXPECT_NEAR(computed.y[i], dp::concentration_out(50.0), 1e-12) << computed.x[i];
  }
  EXPECT_LT(distance_from_lines(charts[1], curve_labelled(charts[1], "two-phase")), 1e-3);
}

TEST(Figures, LegendsSayHowManyPointsAndWhatEmptyElementsDo) {
  const ScratchFolder scratch;
  const auto runs = both_formulations(scratch);
  const std::string points =
      "two-phase, double-point: 3 liquid points per element, empty elements stay dry";
  const Chart solid = make_figure("solid-mass", runs).front();
  curve_labelled(solid, "one-phase, single-point: 1 point per element");
  curve_labelled(solid, points);
  const Curve empty = curve_labelled(make_figure("empty-elements", runs).front(), points);
  EXPECT_TRUE(empty.joined);
  EXPECT_EQ(empty.y.back(), 200.0);
}

TEST(Figures, FluxHasBothEndsAndTheSteadyOne) {
  const ScratchFolder scratch;
  const Chart chart = make_figure("flux", both_formulations(scratch)).front();
  EXPECT_EQ(curve_labelled(chart, "steady q = 0.02 m/s").y, (std::vector<double>{0.02, 0.02}));
  EXPECT_EQ(curve_labelled(chart, "two-phase, double-point: in").dash, Dash::solid);
  EXPECT_EQ(curve_labelled(chart, "two-phase, double-point: out").dash, Dash::dashed);
}

TEST(Figures, BoundariesOfARunHaveStylesOfTheirOwn) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "run.results");
  const auto charts = make_figure("boundaries", {ResultsReader(scratch / "run.results")});
  ASSERT_EQ(charts.size(), 2U);
  ASSERT_EQ(charts[0].curves.size(), 2U);
  const Curve top = curve_labelled(charts[0], "top");
  const Curve bottom = curve_labelled(charts[0], "bottom");
  EXPECT_EQ(top.y.back(), -0.004);
  EXPECT_EQ(bottom.y.back(), 0.005);
  EXPECT_NE(top.dash, bottom.dash);
  EXPECT_NE(top.marker, bottom.marker);
  // No grains left through the top; the curve of the bottom keeps its style.
  ASSERT_EQ(charts[1].curves.size(), 1U);
  const Curve grains = curve_labelled(charts[1], "bottom");
  EXPECT_EQ(grains.dash, bottom.dash);
  EXPECT_NEAR(grains.y.back(), 270.0, 1e-9);
  EXPECT_EQ(grains.x.back(), 120.0);
  draw_figure("boundaries", {ResultsReader(scratch / "run.results")}, scratch / "figure.svg");
  const std::string svg = file_text(scratch / "figure.svg");
  for (const auto* text : {"Liquid that leaves through each boundary", "time (s)",
                           "discharge out of the model (m3/s per metre of thickness)",
                           "Grains that left through each boundary",
                           "mass (kg per metre of thickness)", ">top<", ">bottom<"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

TEST(Figures, BoundariesOfRunsHaveTheirRunsNames) {
  const ScratchFolder scratch;
  const auto charts = make_figure("boundaries", both_formulations(scratch));
  EXPECT_EQ(charts[0].curves.size(), 4U);
  curve_labelled(charts[0], "one-phase, single-point: top");
  EXPECT_EQ(curve_labelled(charts[0], "two-phase, double-point: outflow").y.front(), 0.02);
}

TEST(Figures, ComparisonHasThreeChartsAndOneLegend) {
  const ScratchFolder scratch;
  const auto runs = both_formulations(scratch);
  EXPECT_EQ(make_figure("comparison", runs).size(), 3U);
  draw_figure("comparison", runs, scratch / "figure.svg");
  const std::string svg = file_text(scratch / "figure.svg");
  for (const std::string text :
       {"porosity n_L (-)", "concentration c (-)", "mass (kg per metre of thickness)",
        ">one-phase, single-point<", ">two-phase, double-point<"}) {
    const auto first = svg.find(text);
    EXPECT_NE(first, std::string::npos) << text;
    EXPECT_EQ(svg.find(text, first + 1), std::string::npos) << text << " twice";
  }
}

TEST(Figures, AModelIsThatOfOneRun) {
  const ScratchFolder scratch;
  EXPECT_THROW(draw_figure("model", two_runs(scratch), scratch / "model.png"), InputError);
}

TEST(Figures, RunsOfOneNameAreToldApartByFolder) {
  const ScratchFolder scratch;
  write_synthetic_results(scratch / "coarse.results");
  write_synthetic_results(scratch / "fine.results");
  const Chart chart = make_figure("porosity", {ResultsReader(scratch / "coarse.results"),
                                               ResultsReader(scratch / "fine.results")})
                          .front();
  ASSERT_EQ(chart.curves.size(), 3U);  // one exact curve for both
  EXPECT_EQ(chart.curves[1].label, "coarse");
  EXPECT_EQ(chart.curves[2].label, "fine");
  EXPECT_NE(chart.curves[1].marker, chart.curves[2].marker);
}

TEST(Figures, TitlesSayWhenSoilIsLeftOut) {
  const ScratchFolder scratch;
  Case<2> c = testing::unit_square_case();
  c.document =
      parse_scene(c.document.text + "[soil.base]\nlike = \"specimen\"\nerosion.law = \"none\"\n",
                  "layers.toml");
  c.mesh.region_names.emplace_back("base");
  c.mesh.element_region.back() = 1;
  {
    ResultsWriter<2> writer(scratch / "layers.results", c);
    testing::write_rows(writer, 2.0, [](double) { return 0.3; });
    writer.write_run_info({});
  }
  const std::vector<ResultsReader> layers{ResultsReader(scratch / "layers.results")};
  EXPECT_EQ(make_figure("porosity", layers).front().title, "Mean porosity of the soil that erodes");
  EXPECT_EQ(make_figure("masses", layers).front().title,
            "Mass balance in closed accounting (in the soil that erodes + left - entered)");
  EXPECT_EQ(make_figure("porosity", two_runs(scratch)).front().title, "Mean porosity of the soil");
}

/// The history has the mean porosity of the soil that exchanges fines, the base included.
TEST(Figures, PorosityHasNoExactCurveWhereOtherSoilDeposits) {
  const ScratchFolder scratch;
  Case<2> c = testing::unit_square_case();
  c.document = parse_scene(c.document.text +
                               "[soil.base]\nlike = \"specimen\"\nerosion.law = \"none\"\n"
                               "deposition = {coefficient = 1e-6}\n",
                           "layers.toml", {"time.scheme=implicit"});
  c.mesh.region_names.emplace_back("base");
  c.mesh.element_region.back() = 1;
  {
    ResultsWriter<2> writer(scratch / "layers.results", c);
    testing::write_rows(writer, 2.0, [](double) { return 0.3; });
    writer.write_run_info({});
  }
  const std::vector<ResultsReader> layers{ResultsReader(scratch / "layers.results")};
  const Chart porosity = make_figure("porosity", layers).front();
  EXPECT_EQ(porosity.title, "Mean porosity of the soil that exchanges fines, or of all soil");
  EXPECT_EQ(porosity.curves.size(), 1U);
  // The masses are those of the soil that erodes.
  const Chart solid = make_figure("solid-mass", layers).front();
  EXPECT_EQ(solid.title, "Solid mass of the soil that erodes");
  EXPECT_EQ(solid.curves.size(), 2U);
}

TEST(Figures, TicksAreRoundAndEnclose) {
  const auto ticks = round_ticks(0.3, 0.3987);
  EXPECT_NEAR(ticks.front(), 0.3, 1e-15);
  EXPECT_NEAR(ticks.back(), 0.4, 1e-15);
  EXPECT_NEAR(ticks[1] - ticks[0], 0.02, 1e-15);
  const auto flat = round_ticks(0.3, 0.3);
  EXPECT_LT(flat.front(), 0.3);
  EXPECT_GT(flat.back(), 0.3);
}

/// VTK searches for ever for ticks of its own between ends that are one value.
TEST(Figures, AxesOfOneValueUpToRoundOffAreThoseOfAConstant) {
  for (const double value : {1.0, -1.0, 1e9}) {
    const double low = value - 3e-16 * std::abs(value);
    const auto ticks = round_ticks(low, value);
    EXPECT_GT(ticks.back() - ticks.front(), 0.1 * std::abs(value)) << value;
    if (!(value > 0.0)) continue;
    const auto logarithmic = logarithmic_ticks(low, value);
    EXPECT_GT(logarithmic.high, 1.5 * logarithmic.low) << value;
  }
  EXPECT_LT(round_ticks(1.0, 1.0 + 1e-8).back(), 1.0 + 1e-7);
  Chart chart;
  AxisOptions options;
  options.x_range = "1:1.0000000000000002";
  EXPECT_THROW(set_axes(options, "figure", chart), InputError);
  EXPECT_THROW(parse_range("1:1.0000000000000002"), InputError);
}

TEST(LogarithmicTicks, EncloseWhatThereIs) {
  const auto near = logarithmic_ticks(0.03, 0.4);
  EXPECT_DOUBLE_EQ(near.low, 0.02);
  EXPECT_DOUBLE_EQ(near.high, 0.5);
  ASSERT_EQ(near.ticks.size(), 5U);
  EXPECT_DOUBLE_EQ(near.ticks[2], 0.1);
  // Ends on a tick stay there.
  const auto exact = logarithmic_ticks(0.02, 5.0);
  EXPECT_DOUBLE_EQ(exact.low, 0.02);
  EXPECT_DOUBLE_EQ(exact.high, 5.0);
  const auto wide = logarithmic_ticks(3e-7, 0.4);
  EXPECT_DOUBLE_EQ(wide.low, 2e-7);
  EXPECT_DOUBLE_EQ(wide.high, 0.5);
  ASSERT_EQ(wide.ticks.size(), 6U);
  EXPECT_DOUBLE_EQ(wide.ticks.front(), 1e-6);
  const auto one = logarithmic_ticks(1.0, 1.0);
  EXPECT_LT(one.low, one.high);
  for (const double value : {1e-9, 7e-5, 0.99, 9.99, 1e6}) {
    const auto ticks = logarithmic_ticks(value, 1.5 * value);
    EXPECT_LE(ticks.low, value * (1 + 1e-9));
    EXPECT_GE(ticks.high, 1.5 * value * (1 - 1e-9));
    EXPECT_GE(ticks.ticks.size(), 2U);
  }
}

TEST(Ticks, AreWrittenAsOneWould) {
  EXPECT_EQ(tick_text(6e-6), "6e-6");
  EXPECT_EQ(tick_text(-2.5e-10), "-2.5e-10");
  EXPECT_EQ(tick_text(3e7), "3e7");
  EXPECT_EQ(tick_text(0.35), "0.35");
  EXPECT_EQ(tick_text(0.0), "0");
}

TEST(LogarithmicTicks, Text) {
  EXPECT_EQ(logarithmic_tick_text(1e-5), "1e-5");
  EXPECT_EQ(logarithmic_tick_text(2e-4), "2e-4");
  EXPECT_EQ(logarithmic_tick_text(1e-3), "0.001");
  EXPECT_EQ(logarithmic_tick_text(500), "500");
  EXPECT_EQ(logarithmic_tick_text(1e5), "1e5");
}

}  // namespace figures_test
}  // namespace suffuse

#include "studies/accuracy_chart.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "common/errors.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace accuracy_chart_test {

using testing::ScratchFolder;

const std::string header = "problem,scheme,size,quantity,error_l1,seconds\n";

std::vector<AccuracyRun> read(const std::string& table) {
  const ScratchFolder scratch;
  std::ofstream(scratch / "runs.csv") << table;
  return read_accuracy_runs(scratch / "runs.csv");
}

std::string refusal(const std::string& table) {
  try {
    static_cast<void>(read(table));
  } catch (const InputError& error) {
    const std::string message = error.what();
    return message.substr(message.find("runs.csv"));
  } catch (const FileError& error) {
    const std::string message = error.what();
    return message.substr(message.find("runs.csv"));
  }
  return "not refused";
}

TEST(AccuracyRuns, AreReadByTheNamesOfTheColumns) {
  const auto runs = read(
      "seconds,error_l1,points,quantity,problem,scheme\n"
      "0.5,1e-3,,porosity,dam,sp-implicit\n");
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].problem, "dam");
  EXPECT_EQ(runs[0].scheme, "sp-implicit");
  EXPECT_EQ(runs[0].quantity, "porosity");
  EXPECT_EQ(runs[0].error, 1e-3);
  EXPECT_EQ(runs[0].seconds, 0.5);
}

TEST(AccuracyRuns, OthersAreRefused) {
  EXPECT_EQ(refusal("problem,scheme\n"), "runs.csv:1: no column \"quantity\"");
  EXPECT_EQ(refusal(header + "a,sp-implicit,1,c,1\n"), "runs.csv:2: 5 values in 6 columns");
  EXPECT_EQ(refusal(header + "a,sp-implicit,1,c,nan,1\n"),
            "runs.csv:2: error_l1: got \"nan\"; expected a positive number");
  EXPECT_EQ(refusal(header + "a,sp-implicit,1,c,1,0\n"),
            "runs.csv:2: seconds: got \"0\"; expected a positive number");
  const std::string scheme = refusal(header + "a,sp-implict,1,c,1,1\n");
  EXPECT_TRUE(scheme.starts_with("runs.csv:2: scheme: got \"sp-implict\"; expected \"sp-scaled\""));
  EXPECT_TRUE(scheme.ends_with("did you mean sp-implicit?"));
}

TEST(AccuracyRuns, TheBestHaveNoRunBothFasterAndMoreExact) {
  const auto run = [](double error, double seconds) {
    return AccuracyRun{"p", "sp-implicit", "c", error, seconds};
  };
  const auto best =
      best_runs({run(1e-3, 5), run(1e-1, 1), run(2e-1, 2), run(1e-2, 5), run(5e-2, 2)});
  ASSERT_EQ(best.size(), 3U);
  EXPECT_EQ(best[0].error, 1e-1);
  EXPECT_EQ(best[1].error, 5e-2);
  EXPECT_EQ(best[2].error, 1e-3);
}

TEST(AccuracyCharts, OneForEachFormulationOnTheSameAxes) {
  const auto runs =
      read(header + "a,sp-implicit,1,concentration,1e-2,1\n" +
           "a,sp-implicit,2,concentration,2e-2,2\n" + "a,dp-explicit,1,concentration,1e-4,100\n" +
           "a,paper-explicit,1,concentration,1e-1,1000\n" + "b,sp-scaled,1,concentration,1,1\n");
  const auto charts = accuracy_charts(runs, "a");
  ASSERT_EQ(charts.size(), 2U);
  for (const auto& chart : charts) {
    EXPECT_TRUE(chart.logarithmic_y);
    EXPECT_EQ(chart.extra_x.size(), 4U);
    EXPECT_EQ(chart.x_label, "relative error of the concentration of fluidised grains, L1 (-)");
  }
  // Curves: all runs, and the best one.
  ASSERT_EQ(charts[0].curves.size(), 2U);
  EXPECT_EQ(charts[0].curves[0].x, (std::vector<double>{1e-2, 2e-2}));
  EXPECT_EQ(charts[0].curves[1].x, (std::vector<double>{1e-2}));
  EXPECT_EQ(charts[0].curves[1].label, "implicit");
  EXPECT_EQ(charts[1].curves.size(), 4U);
  try {
    static_cast<void>(accuracy_charts(runs, "c"));
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "suffuse-studies accuracy: --problem: got \"c\"; expected \"a\" or \"b\"; did you "
              "mean a?");
  }
}

// Without colours a marker, or its filling, tells the lines of a chart apart.
TEST(AccuracyCharts, SchemesDifferWithoutColour) {
  std::string table = header;
  for (const std::string formulation : {"sp", "dp", "paper"}) {
    for (const std::string stepping : {"scaled", "explicit", "drag", "implicit"}) {
      table += "a," + formulation + "-" + stepping + ",1,concentration,1e-2,1\n";
    }
  }
  for (const auto& chart : accuracy_charts(read(table), "a")) {
    std::set<std::pair<Marker, bool>> markers;
    std::set<std::string> labels;
    for (const auto& curve : chart.curves) {
      if (curve.label.empty()) continue;
      markers.emplace(curve.marker, curve.hollow);
      labels.insert(curve.label);
    }
    EXPECT_EQ(markers.size(), labels.size());
    EXPECT_EQ(2 * labels.size(), chart.curves.size());
  }
}

TEST(AccuracyCharts, AreDrawn) {
  const auto runs = read(header + "a,sp-implicit,1,concentration,1e-5,1\n" +
                         "a,dp-explicit,1,concentration,1e-2,100\n");
  const ScratchFolder scratch;
  for (const std::string name : {"a.png", "a.svg"}) {
    draw_charts(accuracy_charts(runs, "a"), scratch / name);
    EXPECT_GT(std::filesystem::file_size(scratch / name), 1000U);
  }
  const std::string svg = testing::file_text(scratch / "a.svg");
  EXPECT_NE(svg.find("wall time of the solver (s)"), std::string::npos);
  EXPECT_NE(svg.find("1e-5"), std::string::npos);
}

}  // namespace accuracy_chart_test
}  // namespace suffuse

#include "figures/permeameter_figure.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "common/errors.hpp"
#include "figures/figures.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace permeameter_figure_test {

using testing::file_text;
using testing::ScratchFolder;

/// A test of two hours: fines leave at a share of 0.2 per hour and enter at 0.05 per hour. Pressure
/// steps from 1 to 4 kPa after one hour, conductivity grows as 1 + t/h; there is no flow at first.
/// \param fines  in the liquid, kg
ResultsReader run_of(const ScratchFolder& scratch, const std::string& name,
                     const std::vector<std::string>& changes = {}, double fines = 0.0) {
  Case<2> c = testing::unit_square_case(name);
  c.document = parse_scene(c.document.text, c.document.path, changes);
  const std::string folder = scratch / (name + ".results");
  {
    ResultsWriter<2> writer(folder, c);
    for (const double hours : {0.0, 0.5, 1.0, 1.5, 2.0}) {
      HistoryRow history;
      history.t = 3600.0 * hours;
      history.pressure_min = 500.0;
      history.pressure_max = 500.0 + (hours > 1.0 ? 4000.0 : 1000.0);
      history.flux_out = hours > 0.0 ? 1e-6 * (1.0 + hours) * (history.pressure_max - 500.0) : 0.0;
      LedgerRow ledger;
      ledger.t = history.t;
      ledger.erodible = 270.0 * (1.0 - 0.15 * hours);
      ledger.fines = fines;
      ledger.fines_out = 270.0 * 0.2 * hours;
      ledger.fines_in = 270.0 * 0.05 * hours;
      writer.append_history(history);
      writer.append_ledger(ledger);
    }
    RunInfo info;
    info.status = "done";
    writer.write_run_info(info);
  }
  return ResultsReader(folder);
}

std::string table(const ScratchFolder& scratch, const std::string& text) {
  std::string path = scratch / "measured.csv";
  std::ofstream(path) << text;
  return path;
}

std::string refusal(const auto& body) {
  try {
    body();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(PermeameterFigure, FinesLostAndConductanceAreThoseOfTheTables) {
  const ScratchFolder scratch;
  const auto charts = make_figure("fines-lost", {run_of(scratch, "a"), run_of(scratch, "b")});
  ASSERT_EQ(charts.size(), 2U);
  ASSERT_EQ(charts[0].curves.size(), 2U);
  const Curve& lost = charts[0].curves[1];
  EXPECT_EQ(lost.label, "b");
  ASSERT_EQ(lost.x, (std::vector{0.0, 0.5, 1.0, 1.5, 2.0}));
  for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(lost.y[k], 15.0 * lost.x[k], 1e-12);
  EXPECT_NE(charts[0].curves[0].dash, lost.dash);

  // Its start is the first row in which something flows.
  const Curve& conductance = charts[1].curves[0];
  ASSERT_EQ(conductance.x, (std::vector{0.5, 1.0, 1.5, 2.0}));
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(conductance.y[k], (1.0 + conductance.x[k]) / 1.5, 1e-12);
  }
}

/// A stage starts with some of its fines in the liquid: what is lost is a share of all of them.
TEST(PermeameterFigure, FinesLostAreAShareOfThoseInTheLiquidToo) {
  const ScratchFolder scratch;
  const Curve lost = fines_lost_charts({run_of(scratch, "a", {}, 30.0)}).front().curves.front();
  for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(lost.y[k], 13.5 * lost.x[k], 1e-12);
}

TEST(PermeameterFigure, MeasuredPointsLieBesideTheRunOfTheirName) {
  const ScratchFolder scratch;
  const std::vector<ResultsReader> runs{run_of(scratch, "a"), run_of(scratch, "b")};
  const std::string path = table(scratch, "run,hours,fines_lost\nb,1,14\nb,2,33\n");
  const auto charts = fines_lost_charts(runs, read_measured_points(path));
  ASSERT_EQ(charts[0].curves.size(), 3U);
  const Curve& points = charts[0].curves[2];
  EXPECT_EQ(points.label, "b, measured");
  EXPECT_EQ(points.x, (std::vector{1.0, 2.0}));
  EXPECT_EQ(points.y, (std::vector{14.0, 33.0}));
  EXPECT_TRUE(points.markers && !points.has_line());
  EXPECT_EQ(points.color, charts[0].curves[1].color);
  EXPECT_EQ(charts[1].curves.size(), 2U);

  draw_figure("fines-lost", runs, scratch / "figure.svg", {{}, path});
  const std::string svg = file_text(scratch / "figure.svg");
  for (const auto* text : {"Fines that have left", "time (h)", "b, measured"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

TEST(PermeameterFigure, NoConductanceUnderGravity) {
  const ScratchFolder scratch;
  const ResultsReader run =
      run_of(scratch, "a", {"gravity=[0.0, -9.81]", "initial.water_level=1.0"});
  EXPECT_EQ(fines_lost_charts({run}).size(), 1U);
}

TEST(PermeameterFigure, RefusesTablesAndFiguresThatDoNotFit) {
  const ScratchFolder scratch;
  const std::vector<ResultsReader> runs{run_of(scratch, "a")};
  const auto refused = [&](const std::string& text) {
    const std::string path = table(scratch, text);
    return refusal([&] { fines_lost_charts(runs, read_measured_points(path)); });
  };
  EXPECT_NE(refused("run,hours,fines_lost\nc,1,14\n").find("got \"c\"; expected \"a\""),
            std::string::npos);
  EXPECT_NE(refused("run,hours,fines_lost\n").find("got no row"), std::string::npos);
  EXPECT_NE(refused("run,t,fines_lost\na,1,14\n").find("got no column \"hours\""),
            std::string::npos);
  EXPECT_NE(refused("run,hours,mass\na,1,14\n").find("expected \"fines_lost\" or \"conductance\""),
            std::string::npos);
  const std::string path = table(scratch, "run,hours,fines_lost\na,1,14\n");
  EXPECT_NE(refusal([&] {
              draw_figure("flux", runs, scratch / "a.png", {{}, path});
            }).find("--measured"),
            std::string::npos);
}

}  // namespace permeameter_figure_test
}  // namespace suffuse

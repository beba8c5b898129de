#include "tables/run_table.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "post/synthetic_results.hpp"
#include "values/run_names.hpp"

namespace suffuse {
namespace run_table_test {

using testing::ScratchFolder;

/// Rows by column; no cell of these has a comma.
std::vector<std::map<std::string, std::string>> parsed(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::vector<std::map<std::string, std::string>> rows;
  std::getline(lines, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name);
  EXPECT_EQ(names, run_table_columns());
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    auto& row = rows.emplace_back();
    for (const auto& name : names) std::getline(cells, row[name], ',');
  }
  return rows;
}

TEST(RunTable, DoublePointRun) {
  const ScratchFolder scratch;
  testing::double_point::write_results(scratch / "fine.results");
  const auto rows = parsed(run_table({ResultsReader(scratch / "fine.results")}));
  ASSERT_EQ(rows.size(), 1U);
  auto row = rows.front();
  EXPECT_EQ(row["run"], "fine");
  EXPECT_EQ(row["formulation"], "double-point");
  EXPECT_EQ(row["law"], "constant");
  EXPECT_EQ(row["liquid_per_element"], "3");
  EXPECT_EQ(row["empty_elements"], "dry");
  EXPECT_EQ(row["seeding"], "low-discrepancy");
  EXPECT_EQ(row["steps"], "2000");
  EXPECT_EQ(row["wall_seconds"], "1.5");
  EXPECT_NEAR(std::stod(row["complete_exact"]), 102.0, 1e-9);
  EXPECT_EQ(row["complete_computed"], "inf");  // the run ends before
  EXPECT_EQ(row["empty_elements_total"], "200");
  EXPECT_EQ(row["volume_defect_max"], "0.2");
  EXPECT_EQ(row["darcy_flux"], "0.02");
  for (const auto* name :
       {"error_porosity_percent", "error_solid_percent", "error_eroded_percent"}) {
    EXPECT_LT(std::stod(row[name]), 1e-9) << name;
  }
  // A hundredth of the eroded mass is pending at nodes and missing in the liquid: 2.646 kg at the
  // end, when the liquid should carry most.
  const double eroded = 0.098 * 2700.0;
  const double most = eroded - testing::double_point::fines_out(100.0);
  EXPECT_NEAR(std::stod(row["error_fines_relative"]), 0.01 * eroded / most, 1e-6);
}

// The synthetic run follows Eq. 6 and loses its fines at once.
TEST(RunTable, SinglePointRun) {
  const ScratchFolder scratch;
  testing::write_synthetic_results(scratch / "slow.results", "a", 1e-3);
  testing::write_synthetic_results(scratch / "fast.results", "b", 5e-3);
  auto rows = parsed(run_table(
      {ResultsReader(scratch / "slow.results"), ResultsReader(scratch / "fast.results")}));
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0]["run"], "slow");
  EXPECT_EQ(rows[0]["liquid_per_element"], "");
  EXPECT_EQ(rows[0]["complete_computed"], "102");
  EXPECT_EQ(rows[1]["complete_computed"], "22");
  EXPECT_NEAR(std::stod(rows[1]["complete_exact"]), 22.0, 1e-12);
  EXPECT_LT(std::stod(rows[1]["error_eroded_percent"]), 1e-9);
  // At the end: all fines of the unit square, whose porosity rose from 0.3 to 0.4, have left.
  EXPECT_NEAR(std::stod(rows[0]["eroded"]), 270.0, 1e-9);
  EXPECT_NEAR(std::stod(rows[0]["fines_lost"]), 270.0, 1e-9);
  EXPECT_NEAR(std::stod(rows[0]["fines_lost_percent"]), 100.0, 1e-9);
  EXPECT_EQ(rows[0]["water_out"], "480");
  EXPECT_NEAR(std::stod(rows[0]["porosity_mean"]), 0.4, 1e-12);
  EXPECT_EQ(std::stod(rows[1]["error_fines_relative"]), 1.0);
}

// A stage starts with some of its fines in the liquid: the loss is a share of all of them.
TEST(RunTable, AStageCountsTheFinesInItsLiquid) {
  const ScratchFolder scratch;
  testing::write_synthetic_results(scratch / "a.results", "a", 1e-3);
  const std::string ledger = scratch / "a.results/ledger.csv";
  std::string text = testing::file_text(ledger);
  const std::size_t first = text.find('\n') + 1;
  std::istringstream cells(text.substr(first, text.find('\n', first) - first));
  std::string row;
  std::string cell;
  for (int k = 0; std::getline(cells, cell, ','); ++k) {
    row += (k == 0 ? "" : ",") + (k == 2 ? "4" : k == 4 ? "266" : cell);  // erodible, fines
  }
  text.replace(first, text.find('\n', first) - first, row);
  std::ofstream(ledger) << text;
  auto rows = parsed(run_table({ResultsReader(scratch / "a.results")}));
  EXPECT_NEAR(std::stod(rows[0]["fines_lost_percent"]), 100.0, 1e-9);
}

// A law that depends on the flow has no exact values without the flow.
TEST(RunTable, FluxLawRun) {
  const ScratchFolder scratch;
  const Case<2> c = testing::unit_square_case("flux", "flux", 4.0);
  {
    ResultsWriter<2> writer(scratch / "run.results", c);
    testing::write_rows(writer, 120.0, [](double t) { return 0.3 + 1e-4 * t; });
  }
  auto row = parsed(run_table({ResultsReader(scratch / "run.results")})).front();
  EXPECT_EQ(row["law"], "flux");
  EXPECT_EQ(row["rate"], "4");
  for (const auto* name : {"complete_exact", "error_porosity_percent", "error_solid_percent",
                           "error_eroded_percent"}) {
    EXPECT_EQ(row[name], "") << name;
  }
}

// The run erodes half as fast as it should: the error is largest when the exact erosion ends, at
// 102 s.
TEST(RunTable, ErrorsAreSharesOfTheErodibleMass) {
  const ScratchFolder scratch;
  const Case<2> c = testing::unit_square_case("late", "constant", 1e-3);
  {
    ResultsWriter<2> writer(scratch / "late.results", c);
    testing::write_rows(writer, 120.0,
                        [](double t) { return 0.3 + 0.5e-3 * std::max(0.0, t - 2.0); });
    writer.write_run_info({});
  }
  auto row = parsed(run_table({ResultsReader(scratch / "late.results")})).front();
  for (const auto* name :
       {"error_porosity_percent", "error_solid_percent", "error_eroded_percent"}) {
    EXPECT_NEAR(std::stod(row[name]), 50.0, 1e-9) << name;
  }
  EXPECT_EQ(row["status"], "stopped without notice");
}

/// The row of a run of the unit square whose scene is changed by `changes`.
std::map<std::string, std::string> changed_row(const std::vector<std::string>& changes) {
  const ScratchFolder scratch;
  Case<2> c = testing::unit_square_case();
  c.document = parse_scene(c.document.text, "changed.toml", changes);
  {
    ResultsWriter<2> writer(scratch / "run.results", c);
    testing::write_rows(writer, 120.0, [](double t) { return 0.3 + 5e-4 * t; });
  }
  return parsed(run_table({ResultsReader(scratch / "run.results")})).front();
}

// The porosity of an earlier run and that of soil that deforms are not the scene's.
TEST(RunTable, HasNoExactValuesThatTheSceneDoesNotDetermine) {
  const std::vector<std::vector<std::string>> scenes{
      {"initial.from=before.results"},
      {"time.scheme=implicit", "soil.specimen.skeleton.law=elastic",
       "soil.specimen.skeleton.young=1e7", "soil.specimen.skeleton.poisson=0.3"}};
  EXPECT_NE(changed_row({})["error_porosity_percent"], "");
  for (const auto& changes : scenes) {
    auto row = changed_row(changes);
    for (const auto* name : {"complete_exact", "error_porosity_percent", "error_solid_percent",
                             "error_eroded_percent", "error_fines_relative", "darcy_flux"}) {
      EXPECT_EQ(row[name], "") << name << ", " << changes.front();
    }
  }
}

/// The mean porosity of the history is also that of the soil that deposits.
TEST(RunTable, PorosityHasNoErrorWhereOtherSoilDeposits) {
  const ScratchFolder scratch;
  const auto row_with = [&](const std::string& base) {
    Case<2> c = testing::unit_square_case();
    c.document = parse_scene(c.document.text + "[soil.base]\nlike = \"specimen\"\n" + base,
                             "layers.toml", {"time.scheme=implicit"});
    c.mesh.region_names.emplace_back("base");
    c.mesh.element_region.back() = 1;
    std::filesystem::remove_all(scratch / "run.results");
    {
      ResultsWriter<2> writer(scratch / "run.results", c);
      testing::write_rows(writer, 120.0, [](double t) { return 0.3 + 5e-4 * t; });
    }
    return parsed(run_table({ResultsReader(scratch / "run.results")})).front();
  };
  EXPECT_NE(row_with("erosion.law = \"none\"\n")["error_porosity_percent"], "");
  auto row = row_with("erosion.law = \"none\"\ndeposition = {coefficient = 1e-6}\n");
  EXPECT_EQ(row["error_porosity_percent"], "");
  // The masses are those of the soil that erodes.
  EXPECT_NE(row["error_solid_percent"], "");
  // Soil that erodes and deposits has no exact values anyway.
  row = row_with("deposition = {coefficient = 1e-6}\n");
  EXPECT_EQ(row["error_solid_percent"], "");
}

// No solution uses up fines that the law leaves.
TEST(RunTable, AResidualIsNeverUsedUp) {
  EXPECT_NEAR(std::stod(changed_row({})["complete_exact"]), 102.0, 1e-9);
  auto row = changed_row({"soil.specimen.erosion.residual=0.02"});
  EXPECT_EQ(row["complete_exact"], "inf");
  EXPECT_EQ(row["complete_computed"], "inf");
}

TEST(RunTable, FoldersOfOneNameAreToldApartByTheirPaths) {
  const ScratchFolder scratch;
  std::vector<ResultsReader> runs;
  for (const std::string folder : {"s1/x/a", "s2/x/a", "s2/b"}) {
    std::filesystem::create_directories(scratch / folder);
    testing::write_synthetic_results(scratch / folder + ".results");
    runs.emplace_back(scratch / folder + ".results/");
  }
  const std::vector<std::string> names{"s1/x/a", "s2/x/a", "b"};
  EXPECT_EQ(folder_names(runs), names);
  EXPECT_EQ(run_labels(runs), names);
  const auto rows = parsed(run_table(runs));
  for (std::size_t r = 0; r < rows.size(); ++r) EXPECT_EQ(rows[r].at("run"), names[r]);
  // A run that is given twice keeps its name.
  EXPECT_EQ(folder_names({runs[0], runs[0]}), (std::vector<std::string>{"a", "a"}));
}

}  // namespace run_table_test
}  // namespace suffuse

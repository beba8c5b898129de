/// Losses of the checks and of the report are shares of one dry mass.

#include <gtest/gtest.h>

#include "checks/erosion_checks.hpp"
#include "post/run_programs.hpp"
#include "report/report.hpp"
#include "report/run_numbers.hpp"
#include "values/dry_mass.hpp"

namespace suffuse {
namespace losses_test {

using testing::run_programs;
using testing::ScratchFolder;
using testing::two_layers;

/// Water rises through sand that erodes, and through clay above it, which has fines too but no law.
ResultsReader two_soils(const ScratchFolder& scratch, const std::string& name = "soils",
                        const std::string& more = "initial.flow = \"steady\"\ntime.end = 10.0\n") {
  return run_programs(
      scratch, name,
      "formulation = \"single-point\"\ngravity = [0.0, -9.81]\n"
      "geometry.file = \"" +
          name +
          ".geo\"\nmesh.size = 0.25\n"
          "liquid = { density = 1000.0, bulk_modulus = inf, viscosity = 1e-3 }\n"
          "output.every = 5.0\n" +
          more +
          "[soil.sand]\nporosity = 0.35\nskeleton_fraction = 0.55\ngrain_density = 2650.0\n"
          "conductivity = 1e-1\nerosion = { law = \"constant\", rate = 1e-3 }\n"
          "[soil.clay]\nporosity = 0.4\nskeleton_fraction = 0.4\ngrain_density = 2650.0\n"
          "conductivity = 1e-1\n"
          "[[boundary]]\non = \"bottom\"\nhead = 4.0\nconcentration = 0.0\n"
          "[[boundary]]\non = \"top\"\nhead = 2.0\nconcentration = 0.0\n",
      two_layers());
}

/// What has eroded has left, or is in the liquid.
TEST(Losses, OfReportAndCheckAreSharesOfTheDryMassOfSoilsThatExchangeFines) {
  const ScratchFolder scratch;
  const ResultsReader results = two_soils(scratch);
  const double mass = dry_mass_at_start(results);
  EXPECT_NEAR(mass, 0.65 * 2650.0 * 0.5, 1e-9);
  const RunNumbers numbers = run_numbers(results);
  // The fines of the clay have no part in it.
  EXPECT_NEAR(results.history().column("fines_out_percent").back(),
              100.0 * *numbers.fines_out / (0.1 * 2650.0 * 0.5), 1e-9);
  ASSERT_TRUE(numbers.fines_percent.has_value());
  EXPECT_NEAR(*numbers.fines_percent, 100.0 * *numbers.fines_out / mass, 1e-12);
  EXPECT_GT(*numbers.fines_out, 0.0);
  const std::vector<CheckRow> rows = loss_checks(results);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_NEAR(rows[0].effect,
              *numbers.fines_percent + 100.0 * results.ledger().column("fines").back() / mass,
              1e-9);
  EXPECT_TRUE(rows[0].note.ends_with(" % of its dry mass at the start")) << rows[0].note;
  const std::string basis = " % of the dry mass at the start of the soils that exchange fines";
  EXPECT_NE(summary_text(results, numbers).find(basis), std::string::npos);
  EXPECT_NE(report_html({results}).find("<figcaption>Fines that left the model, in" + basis),
            std::string::npos);
}

/// Two stages of 10 s lose as much as one run of 20 s.
TEST(Losses, OfALaterStageCountFromTheFirst) {
  const ScratchFolder scratch;
  const std::string flow = "initial.flow = \"steady\"\n";
  const std::vector<CheckRow> whole =
      loss_checks(two_soils(scratch, "whole", flow + "time.end = 20.0\n"));
  const double first =
      loss_checks(two_soils(scratch, "first", flow + "time.end = 10.0\n")).at(0).effect;
  const ResultsReader second =
      two_soils(scratch, "second", "initial.from = \"first.results\"\ntime.end = 10.0\n");
  const std::vector<CheckRow> rows = loss_checks(second);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_GT(first, 0.1);
  EXPECT_NEAR(rows[0].effect, whole.at(0).effect, 1e-6 * rows[0].effect);
  EXPECT_NE(summary_text(second, run_numbers(second)).find(" left the model in this stage, "),
            std::string::npos);
}

/// A results folder: 90 kg of the soil slide into free water, and 1.5 kg of its fines erode.
void write_slide(const std::string& folder) {
  const Case<2> c = testing::open_above_case(1.0);
  ResultsWriter<2> writer(folder, c);
  LedgerRow soil;
  LedgerRow water;
  soil.solid = 1000.0;
  for (const double t : {0.0, 10.0}) {
    soil.t = water.t = t;
    if (t > 0.0) {
      soil.carried = -90.0;
      soil.eroded = soil.fines_out = 1.5;
      soil.solid = 1000.0 - 90.0 - 1.5;
      water.carried = water.solid = 90.0;
    }
    writer.append_ledger(soil);
    writer.append_regions(std::array<RegionRow, 2>{{{0, 0.3, soil}, {1, 1.0, water}}});
  }
  RunInfo info;
  info.status = "done";
  writer.write_run_info(info);
}

TEST(Losses, AreNotWhatSlidesIntoAnotherRegion) {
  const ScratchFolder scratch;
  const std::string folder = scratch / "slide.results";
  write_slide(folder);
  const std::vector<CheckRow> rows = loss_checks(ResultsReader(folder));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_NEAR(rows[0].effect, 0.15, 1e-12);
  EXPECT_TRUE(rows[0].note.starts_with("no erosion: ")) << rows[0].note;
}

/// `carried` is the last column, which earlier versions did not write.
TEST(Losses, OfEarlierVersionsCountAllThatIsMissing) {
  const ScratchFolder scratch;
  const std::string folder = scratch / "slide.results";
  write_slide(folder);
  std::istringstream table(testing::file_text(folder + "/regions.csv"));
  std::ofstream out(folder + "/regions.csv");
  for (std::string line; std::getline(table, line);) out << line.substr(0, line.rfind(',')) << '\n';
  out.close();
  ASSERT_FALSE(ResultsReader(folder).region_ledgers().has("carried"));
  EXPECT_NEAR(loss_checks(ResultsReader(folder)).at(0).effect, 9.15, 1e-12);
}

}  // namespace losses_test
}  // namespace suffuse

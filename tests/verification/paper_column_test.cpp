/// The paper's single-point column from its scene files to the tables, run as by a user.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "driver/run.hpp"
#include "geometry.hpp"
#include "model_run.hpp"
#include "reference_table.hpp"
#include "results/reader.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace paper_column_test {

namespace fs = std::filesystem;

/// Meshes and runs a scene of workflows/paper in a folder of its own.
class PaperRun {
 public:
  explicit PaperRun(const std::string& scene, const std::vector<std::string>& overrides = {})
      : folder_(fs::path(::testing::TempDir()) / (test_name() + "-" + scene + ".results")) {
    fs::remove_all(folder_);
    Case<2> c;
    c.document =
        read_scene(test::source_folder() + "/workflows/paper/" + scene + ".toml", overrides);
    c.mesh = build_geometry_of<2>(c.document).mesh;
    c.solid_points = seed_solid_points(c.mesh, c.document.scene.points);
    const SolverOptions options;
    const Plan plan = make_plan(c, options);
    EXPECT_EQ(run_case(c, plan, options, folder_.string(), {.quiet = true}), 0);
    const ResultsReader reader(folder_.string());
    history_ = reader.history();
    ledger_ = reader.ledger();
  }
  PaperRun(const PaperRun&) = delete;
  PaperRun& operator=(const PaperRun&) = delete;
  ~PaperRun() { fs::remove_all(folder_); }

  [[nodiscard]] const Table& history() const { return history_; }
  [[nodiscard]] const Table& ledger() const { return ledger_; }

  /// Row at time t.
  [[nodiscard]] std::size_t row(double t) const {
    const auto& times = history_.column("t");
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i] == t) return i;
    }
    ADD_FAILURE() << "no row at t = " << t;
    return 0;
  }

 private:
  /// The name of the test without the slash of parametrised tests.
  static std::string test_name() {
    std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '-');
    return name;
  }

  fs::path folder_;
  Table history_;
  Table ledger_;
};

/// Largest residual of either constituent in any row.
double worst_residual(const Table& ledger) {
  double worst = 0.0;
  for (const char* name : {"residual_water", "residual_grains"}) {
    for (const double r : ledger.column(name)) worst = std::max(worst, std::abs(r));
  }
  return worst;
}

struct PaperCase {
  const char* scene;
  const char* porosity_column;  ///< of porosity.csv
  const char* law;              ///< of masses.csv
  double rate;
  std::vector<std::string> overrides;  ///< of the scene
};

/// The paper's scene with the implicit scheme: with steps of one second, or by tolerance.
const std::vector<std::string> implicit_one_second{"time={end=120.0,step=1.0}"};
const std::vector<std::string> implicit_tolerance{"time={end=120.0}"};

class PaperColumn : public ::testing::TestWithParam<PaperCase> {};

TEST_P(PaperColumn, PorosityAndMassesAreExact) {
  const PaperCase& expected = GetParam();
  const PaperRun run(expected.scene, expected.overrides);
  const auto& porosity = run.history().column("porosity_mean");
  int compared = 0;
  double worst = 0.0;
  for (const auto& row : read_reference("porosity.csv")) {
    const double t = row.number("t");
    if (t > 120.0) continue;
    const double error =
        std::abs(porosity[run.row(t)] - row.number(expected.porosity_column)) / 0.1;
    EXPECT_LE(error, 1e-6) << "t = " << t;
    worst = std::max(worst, error);
    ++compared;
  }
  EXPECT_GE(compared, 22);
  std::cout << expected.scene << (expected.overrides.empty() ? "" : ", implicit")
            << ": largest porosity error / 0.1 = " << worst << '\n';
  // Porosity must not exceed the cap, not even by round-off of the mean beyond one part in 1e15.
  for (const double n : porosity) EXPECT_LE(n, 0.4 * (1.0 + 4e-16));

  compared = 0;
  for (const auto& row : read_reference("masses.csv")) {
    const double t = row.number("t");
    if (row.text("law") != expected.law || row.number("par") != expected.rate || t > 120.0)
      continue;
    const std::size_t i = run.row(t);
    EXPECT_NEAR(run.ledger().column("solid")[i] / row.number("M_solid"), 1.0, 1e-6);
    EXPECT_NEAR(run.ledger().column("eroded")[i], row.number("M_eroded_total"),
                1e-6 * std::max(1.0, row.number("M_eroded_total")));
    ++compared;
  }
  EXPECT_GE(compared, 14);
  EXPECT_LE(worst_residual(run.ledger()), 1e-12);
  for (const double c : run.history().column("concentration_min")) EXPECT_GE(c, 0.0);
  for (const double c : run.history().column("concentration_max")) EXPECT_LT(c, 1.0);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, PaperColumn,
    ::testing::Values(
        PaperCase{"sp-constant-table", "n_const_alpha1e-3", "const", 1e-3, {}},
        PaperCase{"sp-constant-figure", "n_const_alpha5e-3", "const", 5e-3, {}},
        PaperCase{"sp-logarithmic", "n_log_beta1e-2", "log", 1e-2, {}},
        PaperCase{"sp-constant-table", "n_const_alpha1e-3", "const", 1e-3, implicit_one_second},
        PaperCase{"sp-constant-figure", "n_const_alpha5e-3", "const", 5e-3, implicit_one_second},
        PaperCase{"sp-logarithmic", "n_log_beta1e-2", "log", 1e-2, implicit_one_second},
        PaperCase{"sp-constant-figure", "n_const_alpha5e-3", "const", 5e-3, implicit_tolerance},
        PaperCase{"sp-logarithmic", "n_log_beta1e-2", "log", 1e-2, implicit_tolerance}),
    [](const auto& param_info) {
      std::string name = param_info.param.scene;
      if (param_info.param.overrides == implicit_one_second) name += "_implicit_one_second";
      if (param_info.param.overrides == implicit_tolerance) name += "_implicit";
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

TEST(PaperColumnExhaustion, TheConstantLawEndsAtItsExactTime) {
  // 0.1 / 5e-3 = 20 s after the start at 2 s; rows every 0.0625 s, off the solver's own steps.
  const PaperRun run("sp-constant-figure",
                     {"output.every=0.0625", "time.end=23.0", "output.snapshot_every=23.0"});
  const auto& t = run.history().column("t");
  const auto& n = run.history().column("porosity_mean");
  for (std::size_t i = 0; i < t.size(); ++i) {
    EXPECT_NEAR(n[i], std::min(0.4, 0.3 + 5e-3 * std::max(0.0, t[i] - 2.0)), 1e-14) << t[i];
  }
}

/// Largest difference between two tables, relative to each column's largest value.
double largest_difference(const Table& a, const Table& b, const std::vector<std::string>& names) {
  double worst = 0.0;
  for (const std::string& name : names) {
    const auto& x = a.column(name);
    const auto& y = b.column(name);
    EXPECT_EQ(x.size(), y.size());
    double scale = 0.0;
    double difference = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      scale = std::max(scale, std::abs(x[i]));
      difference = std::max(difference, std::abs(x[i] - y[i]));
    }
    if (scale > 0.0) worst = std::max(worst, difference / scale);
  }
  return worst;
}

const std::vector<std::string> masses{"solid",  "erodible", "water",     "fines",
                                      "eroded", "water_in", "water_out", "fines_out"};

TEST(PaperColumnPoints, TheAnswerDoesNotDependOnTheNumberOfPoints) {
  const PaperRun three("sp-logarithmic");
  for (const int points : {1, 6, 12}) {
    const PaperRun other("sp-logarithmic", {"points.solid_per_element=" + std::to_string(points)});
    EXPECT_LE(largest_difference(three.ledger(), other.ledger(), masses), 1e-12) << points;
    EXPECT_LE(largest_difference(three.history(), other.history(), {"porosity_mean"}), 1e-12);
  }
}

TEST(PaperColumnPoints, OffTheGaussPositionsTheSolidIsUntouchedAndFinesMoveALittle) {
  const PaperRun gauss("sp-constant-figure");
  const PaperRun moved("sp-constant-figure", {"points.jitter=0.1"});
  // Porosity is uniform, so the erosion of a point does not depend on its place.
  EXPECT_LE(largest_difference(gauss.ledger(), moved.ledger(), {"solid", "erodible", "eroded"}),
            1e-12);
  EXPECT_LE(largest_difference(gauss.history(), moved.history(), {"porosity_mean"}), 1e-12);
  EXPECT_LE(worst_residual(moved.ledger()), 1e-12);
  const double fines = largest_difference(gauss.ledger(), moved.ledger(), {"fines", "fines_out"});
  EXPECT_GT(fines, 1e-9) << "the points were to be moved";
  EXPECT_LE(fines, 0.02);
  std::cout << "points moved by up to 0.1 of the element size: fines change by " << 100.0 * fines
            << " % of their largest mass, porosity and solid mass not at all\n";
}

TEST(PaperColumnDirection, AnUpwardRunMirrorsTheDownwardOne) {
  const PaperRun down("sp-constant-figure");
  const PaperRun up("sp-constant-figure", {"boundary[0].on=bottom", "boundary[1].on=top"});
  // The mirrored mesh adds numbers in another order; the oscillating flow carries that round-off
  // on.
  EXPECT_LE(largest_difference(down.ledger(), up.ledger(), masses), 1e-10);
  EXPECT_LE(largest_difference(down.history(), up.history(),
                               {"porosity_mean", "flux_in", "flux_out", "pressure_max"}),
            1e-9);
}

TEST(PaperColumnLong, BalancesCloseAfterAHundredThousandSteps) {
  const PaperRun run("sp-logarithmic", {"time.step=8.0e-4", "time.mass_scaling=1", "time.end=85",
                                        "output.every=0.5", "output.snapshot_every=85"});
  EXPECT_LE(worst_residual(run.ledger()), 1e-12);
  EXPECT_EQ(run.history().rows(), 171u);
  std::cout << "1e5 steps: worst residual " << worst_residual(run.ledger()) << '\n';
}

}  // namespace paper_column_test
}  // namespace suffuse

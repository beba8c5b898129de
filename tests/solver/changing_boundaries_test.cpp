/// Boundary values that change in time: volumes and exchanged fines against their integrals.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <sstream>

#include "results/reader.hpp"
#include "solver/solver_process.hpp"

namespace suffuse {
namespace changing_boundaries_test {

/// A column with this soil, these boundaries and more keys.
std::string column(double size, const std::string& soil, const std::string& boundaries,
                   const std::string& more) {
  std::ostringstream text;
  text << "formulation = \"single-point\"\n"
       << "geometry = { shape = \"column\", width = 0.1, height = 1.0 }\n"
       << "mesh.size = " << size << "\n"
       << "liquid = { density = 1000.0, bulk_modulus = inf, viscosity = 1e-3 }\n"
       << "[soil.specimen]\nporosity = 0.3\nskeleton_fraction = 0.6\ngrain_density = 2650.0\n"
       << soil << boundaries << more;
  return text.str();
}

struct ColumnRun {
  explicit ColumnRun(const std::string& scene, const std::vector<std::string>& sets = {})
      : outcome(place.solve(place.make_case({"column", scene, sets}), place.path("results"))),
        results(place.path("results")) {}

  /// The last value of a column of a boundary's table.
  [[nodiscard]] double at_boundary(const std::string& name, const std::string& column) const {
    for (const NamedTable& boundary : results.boundaries()) {
      if (boundary.name == name) return boundary.table.column(column).back();
    }
    return std::nan("");
  }

  test::Workplace place;
  test::Outcome outcome;
  ResultsReader results;
};

/// A tide of 12 hours for 10 days, as pairs of time and value between `high` and -`high`.
std::string tide(double high) {
  std::ostringstream text;
  for (int half = 0; half <= 40; ++half) {
    text << (half > 0 ? ", " : "[") << '[' << 21600.0 * half << ", "
         << (half % 2 == 0 ? high : -high) << ']';
  }
  return text.str() + ']';
}

/// Gradients |i| of a triangular tide are even in [0, 1/2], so that the mean of <|i| - 1/4> is
/// 1/16, and that of the flux into one end k/8.
TEST(ChangingBoundaries, ATideErodesAndFlowsBothWays) {
  const double days = 864000.0;
  const double eroded = 0.1 * 0.1 * 2650.0 * (1.0 - std::exp(-1e-6 * days / 16.0));
  const double volume = 0.1 * 1e-4 * days / 8.0;
  const auto errors = [&](const std::string& tolerance) {
    const ColumnRun run(
        column(0.1,
               "conductivity = 1e-4\nerosion = { law = \"first-order\", drive = \"gradient\", rate "
               "= 1e-6, threshold = 0.25 }\n",
               "[[boundary]]\non = \"top\"\nconcentration = 0.0\npressure = " + tide(4905.0) +
                   "\n[[boundary]]\non = \"bottom\"\npressure = 0.0\n",
               "[initial]\nflow = \"steady\"\n[time]\nend = 864000.0\n[output]\nevery = 86400.0\n"),
        {"time.tolerance=" + tolerance});
    EXPECT_EQ(run.outcome.code, 0) << run.outcome.error;
    const std::array<double, 2> off{
        std::abs(run.results.ledger().column("eroded").back() / eroded - 1.0),
        std::abs(run.at_boundary("top", "liquid_in") / volume - 1.0)};
    std::cout << "tolerance " << tolerance << ": eroded mass off by " << off[0] << ", inflow by "
              << off[1] << '\n';
    return off;
  };
  const auto coarse = errors("1e-3");
  const auto fine = errors("1e-4");
  EXPECT_LT(coarse[0], 0.01);
  EXPECT_LT(coarse[1], 0.01);
  EXPECT_LT(fine[1], 0.3 * coarse[1]);
}

/// One stage of an implicit step has the mean flux of the step: a table brings in its volume.
TEST(ChangingBoundaries, AFluxThatRisesBringsInTheVolumeOfItsTable) {
  const std::string skeleton =
      "[soil.specimen.skeleton]\nlaw = \"elastic\"\nyoung = 1e7\npoisson = 0.3\n";
  const std::string retention =
      "retention = { model = \"van-genuchten\", alpha = 3.0, n = 1.6, residual_saturation = 0.1 "
      "}\n";
  const std::string fixed = "fix = \"both\"\n";
  for (const std::string& soil : {skeleton, retention}) {
    for (const std::string key : {"darcy_flux", "velocity"}) {
      const ColumnRun run(
          column(0.1, "conductivity = 1e-5\n" + soil,
                 "[[boundary]]\non = \"bottom\"\n" + key + " = [[0.0, 0.0], [1e5, 1e-6]]\n" +
                     (soil == skeleton ? fixed : "") + "[[boundary]]\non = \"top\"\nhead = 1.0\n",
                 "[time]\nend = 1e5\n[output]\nevery = 1e5\n"),
          {"gravity=[0.0,-9.81]"});
      EXPECT_EQ(run.outcome.code, 0) << run.outcome.error;
      const double exact = 0.1 * 0.5 * 1e-6 * 1e5 * (key == "velocity" ? 0.3 : 1.0);
      // The pores that a velocity flows through open under its water.
      const double off = key == "velocity" && soil == skeleton ? 1e-4 : 1e-6;
      EXPECT_NEAR(run.at_boundary("bottom", "liquid_in"), exact, off * exact)
          << key << ", " << soil;
    }
  }
}

/// A flux rises to twice `flux_max` of deposition, which ends in the middle of the run.
TEST(ChangingBoundaries, DepositionEndsAtItsLargestFlux) {
  const auto deposited = [](const std::string& every, const std::string& tolerance) {
    const ColumnRun run(
        column(0.1, "conductivity = 1e-3\ndeposition = { coefficient = 5.0, flux_max = 1e-3 }\n",
               "[[boundary]]\non = \"top\"\nconcentration = 0.05\npressure = [[0.0, 0.0], [500.0, "
               "19620.0]]\n[[boundary]]\non = \"bottom\"\npressure = 0.0\n",
               "[initial]\nflow = \"steady\"\n[time]\nend = 500.0\n[output]\n"),
        {"output.every=" + every, "time.tolerance=" + tolerance});
    EXPECT_EQ(run.outcome.code, 0) << run.outcome.error;
    return run.results.ledger().column("deposited").back();
  };
  const double exact = deposited("1.0", "1e-3");  // steps of the flow end on rows
  for (const char* tolerance : {"1e-3", "1e-5"}) {
    const double off = deposited("500.0", tolerance) / exact - 1.0;
    std::cout << "tolerance " << tolerance << ": deposits off by " << off << '\n';
    EXPECT_LT(std::abs(off), 0.08);
  }
}

TEST(ChangingBoundaries, AFluxThatDriedSoilCannotGiveIsRefused) {
  const ColumnRun run(
      column(0.05,
             "conductivity = 1e-5\nretention = { model = \"van-genuchten\", alpha = 3.0, n = 1.6, "
             "residual_saturation = 0.1 }\n",
             "[[boundary]]\non = \"bottom\"\ndarcy_flux = -1e-6\n",
             "[initial]\nwater_level = 1.0\n[time]\nend = 250000.0\n[output]\nevery = 10000.0\n"),
      {"gravity=[0.0,-9.81]"});
  EXPECT_EQ(run.outcome.code, 3);
  EXPECT_NE(run.outcome.error.find("boundary \"bottom\" takes water that the soil does not give"),
            std::string::npos)
      << run.outcome.error;
  // A solution of Richards' equation on 200 cells gives the flux until 9.2e4 s.
  const double last = run.results.history().column("t").back();
  EXPECT_GT(last, 8.5e4);
  EXPECT_LT(last, 1.1e5);
}

}  // namespace changing_boundaries_test
}  // namespace suffuse

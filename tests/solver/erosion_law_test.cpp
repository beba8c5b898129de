#include "physics/erosion/erosion_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "physics/numbers.hpp"
#include "reference_table.hpp"
#include "test_paths.hpp"
#include "verification/model_run.hpp"

namespace suffuse {

namespace erosion {
extern const ErosionLaw second_order;  // not in the list, like an added law
}  // namespace erosion

namespace erosion_law_test {

constexpr double n_0 = 0.3;
constexpr double n_max = 0.4;
constexpr double start = 2.0;
constexpr double flux = 0.012;
ErosionModel model(const ErosionLaw* law, double rate) {
  ErosionModel result{law, rate, start, n_max};
  if (!law->drive.empty()) result.drive = drive_law(law->drive);
  return result;
}

// Checks that hold for every law.

class EveryLaw : public ::testing::TestWithParam<const ErosionLaw*> {
 protected:
  /// Erodes a good part of the fines within a minute.
  static ErosionModel some_model() {
    const double size =
        GetParam()->erodes() ? erosion_rate(model(GetParam(), 1.0), n_0, start, flux) : 1.0;
    return model(GetParam(), 1.2e-3 / size);
  }
};

std::vector<const ErosionLaw*> laws_to_test() {
  std::vector<const ErosionLaw*> laws(erosion_laws().begin(), erosion_laws().end());
  laws.push_back(&erosion::second_order);
  // exchange_test.cpp covers laws that depend on the fines in the liquid.
  std::erase_if(laws, [](const ErosionLaw* law) { return law->depends_on_concentration; });
  return laws;
}

INSTANTIATE_TEST_SUITE_P(Laws, EveryLaw, ::testing::ValuesIn(laws_to_test()),
                         [](const auto& param_info) {
                           std::string name(param_info.param->word);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

/// Classical Runge-Kutta with the rate alone, from the start of erosion on.
double integrated(const ErosionModel& m, double duration, int steps) {
  const double h = duration / steps;
  double n = n_0;
  for (int s = 0; s < steps; ++s) {
    const double t = start + h * s;
    const double k1 = erosion_rate(m, n, t, flux);
    const double k2 = erosion_rate(m, n + 0.5 * h * k1, t + 0.5 * h, flux);
    const double k3 = erosion_rate(m, n + 0.5 * h * k2, t + 0.5 * h, flux);
    const double k4 = erosion_rate(m, n + h * k3, t + h, flux);
    n += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return n;
}

TEST_P(EveryLaw, StepIsTheIntegralOfTheRate) {
  const ErosionModel m = some_model();
  const double duration = 60.0;
  const double n = porosity_after(m, n_0, 0.0, start + duration, flux);
  EXPECT_EQ(n > n_0 + 0.01, GetParam()->erodes());
  EXPECT_LT(n, n_max);
  EXPECT_NEAR(integrated(m, duration, 1000), n, 1e-13);
  const double coarse = std::abs(integrated(m, duration, 16) - n);
  const double fine = std::abs(integrated(m, duration, 32) - n);
  if (coarse > 1e-12) {
    EXPECT_GT(std::log2(coarse / fine), 3.8) << coarse << ' ' << fine;
  }
}

TEST_P(EveryLaw, StepMayBeSplit) {
  const ErosionModel m = some_model();
  for (const double end : {10.0, 60.0, 300.0}) {
    const double once = porosity_after(m, n_0, 0.0, end, flux);
    for (const int steps : {2, 7, 100, 1000}) {
      double n = n_0;
      double t = 0.0;
      for (int s = 1; s <= steps; ++s) {  // unequal steps
        const double next = end * s * s / (static_cast<double>(steps) * steps);
        n = porosity_after(m, n, t, next, flux);
        t = next;
      }
      EXPECT_NEAR(n, once, 1e-12) << steps << " steps to " << end;
    }
  }
}

TEST_P(EveryLaw, FollowsItsExactSolution) {
  const ErosionModel m = some_model();
  EXPECT_EQ(has_exact_porosity(m), !m.drive->depends_on_flow());
  for (const double t : {1.0, 2.0, 2.1, 10.0, 60.0, 300.0, 3000.0}) {
    EXPECT_NEAR(exact_porosity(m, n_0, t, flux), porosity_after(m, n_0, 0.0, t, flux), 1e-12) << t;
  }
}

TEST_P(EveryLaw, BreaksOnlyAtItsBreakpoints) {
  const ErosionModel m = some_model();
  const std::vector<double> times = breakpoints(m, n_0);
  EXPECT_EQ(erosion_rate(m, n_0, 0.999 * start, flux), 0.0);
  EXPECT_EQ(porosity_after(m, n_0, 0.0, start, flux), n_0);
  if (!GetParam()->erodes()) {
    EXPECT_TRUE(times.empty());
    return;
  }
  EXPECT_EQ(times.front(), start);
  EXPECT_GT(erosion_rate(m, n_0, start, flux), 0.0);
  EXPECT_GT(porosity_after(m, n_0, 0.0, start + 1e-6, flux), n_0);
  const double end = exhaustion_time(m, n_0);
  if (std::isfinite(end)) {
    ASSERT_EQ(times.size(), 2U);
    EXPECT_EQ(times.back(), end);
    EXPECT_LT(porosity_after(m, n_0, 0.0, end - 1e-6, flux), n_max);
    EXPECT_EQ(porosity_after(m, n_0, 0.0, end + 1e-6, flux), n_max);
  } else {
    EXPECT_EQ(times.size(), 1U);
    EXPECT_LT(porosity_after(m, n_0, 0.0, start + 300.0, flux), n_max);
  }
}

TEST_P(EveryLaw, StaysWithinItsBounds) {
  const ErosionModel m = some_model();
  for (const double flow : {0.0, flux, 1e3, infinity}) {
    double before = n_0;
    for (double t = 10.0; t < 2000.0; t += 10.0) {
      const double n = porosity_after(m, before, t - 10.0, t, flow);
      ASSERT_GE(n, before) << flow << ' ' << t;
      ASSERT_LE(n, n_max) << flow << ' ' << t;
      before = n;
    }
    EXPECT_LE(porosity_after(m, n_0, 0.0, 1e15, flow), n_max) << flow;
  }
  EXPECT_EQ(erosion_rate(m, n_max, 200.0, flux), 0.0);
  EXPECT_EQ(porosity_after(m, n_max, 0.0, 200.0, flux), n_max);
  EXPECT_EQ(exhaustion_time(m, n_max), start);
}

TEST_P(EveryLaw, DependsOnTheFluxOrNot) {
  const ErosionModel m = some_model();
  const double slow = porosity_after(m, n_0, 0.0, 20.0, flux);
  if (m.drive->depends_on_flow()) {
    EXPECT_TRUE(depends_on_flux(m));
    EXPECT_GT(porosity_after(m, n_0, 0.0, 20.0, 2.0 * flux), slow);
    EXPECT_TRUE(std::isnan(porosity_after(m, n_0, 0.0, 20.0, unset)));
    EXPECT_TRUE(std::isnan(erosion_rate(m, n_0, 20.0, unset)));
    EXPECT_EQ(porosity_after(m, n_0, 0.0, 20.0, 0.0), n_0);  // still water erodes nothing
  } else {
    EXPECT_FALSE(depends_on_flux(m));
    EXPECT_EQ(porosity_after(m, n_0, 0.0, 20.0, unset), slow);
    EXPECT_FALSE(std::isnan(erosion_rate(m, n_0, 20.0, unset)));
  }
}

TEST_P(EveryLaw, WithoutARateErodesNothing) {
  ErosionModel m = some_model();
  m.rate = 0.0;
  EXPECT_FALSE(erodes(m));
  EXPECT_FALSE(depends_on_flux(m));
  EXPECT_EQ(porosity_after(m, n_0, 0.0, 20.0, infinity), n_0);
  EXPECT_EQ(exhaustion_time(m, n_0), infinity);
  EXPECT_TRUE(breakpoints(m, n_0).empty());
}

TEST(ErosionLaws, AreFoundByTheirWords) {
  std::set<std::string_view> words;
  for (const ErosionLaw* law : erosion_laws()) {
    EXPECT_EQ(erosion_law(law->word), law);
    EXPECT_FALSE(law->equation.empty());
    EXPECT_EQ(law->rate_symbol.empty(), !law->erodes()) << law->word;
    EXPECT_EQ(law->porosity_after == nullptr, !law->erodes() || law->depends_on_concentration)
        << law->word;
    words.insert(law->word);
  }
  EXPECT_EQ(words.size(), erosion_laws().size());
  EXPECT_FALSE(no_erosion()->erodes());
  EXPECT_THROW(erosion_law("constnat"), std::invalid_argument);
}

/// The solver accepts a law that is in no list and that no other source names.
TEST(ErosionLaws, RunWithoutBeingKnown) {
  Scene scene = model::paper_scene();
  scene.soils[0].erosion.law = &erosion::second_order;
  scene.soils[0].erosion.rate = 0.5;
  scene.soils[0].erosion.start = start;
  scene.boundaries = {model::flux_on("top", flux), model::pressure_on("bottom", 0.0)};
  scene.initial_flow = InitialFlow::steady;
  scene.time.end = 20.0;
  model::ModelRun run(model::make_case(model::column_mesh(4, 4), scene));
  const auto moments = run.run({7.0, 20.0});
  for (const auto& [t, state] : {std::pair{7.0, 0}, {20.0, 1}}) {
    const double left = 0.1 / (1.0 + 0.5 * 0.1 * (t - start));
    for (const double n : moments.states[state].porosity) EXPECT_NEAR(n, 0.4 - left, 1e-12) << t;
  }
  EXPECT_LE(run.worst_residual(), 1e-12);
}

TEST(ErosionLaws, AreAddedAsTheDocumentationSays) {
  const auto text_of = [](const std::string& file) {
    std::ifstream in(test::source_folder() + file);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string law = text_of("/tests/solver/second_order.cpp");
  ASSERT_NE(law.find("second_order"), std::string::npos);
  EXPECT_NE(text_of("/docs/develop/contributing.md").find("```cpp\n" + law + "```"),
            std::string::npos);
}

// Single laws, by numbers.

TEST(ErosionLaws, FollowTheReferenceTable) {
  const auto rows = read_reference("porosity.csv");
  ASSERT_GT(rows.size(), 20u);
  for (const auto& row : rows) {
    const double t = row.number("t");
    EXPECT_NEAR(porosity_after(model(erosion_law("constant"), 1e-3), n_0, 0.0, t, unset),
                row.number("n_const_alpha1e-3"), 1e-13);
    EXPECT_NEAR(porosity_after(model(erosion_law("constant"), 5e-3), n_0, 0.0, t, unset),
                row.number("n_const_alpha5e-3"), 1e-13);
    EXPECT_NEAR(porosity_after(model(erosion_law("logarithmic"), 1e-2), n_0, 0.0, t, unset),
                row.number("n_log_beta1e-2"), 5e-13);
  }
}

TEST(FirstOrderLaw, DecaysExponentially) {
  const ErosionModel m = model(erosion_law("first-order"), 0.05);
  EXPECT_NEAR(porosity_after(m, n_0, 0.0, 42.0, unset), n_max - 0.1 * std::exp(-0.05 * 40.0),
              1e-15);
}

TEST(FluxLaw, DecaysWithTheLiquidThatPasses) {
  const ErosionModel m = model(erosion_law("flux"), 4.0);
  EXPECT_NEAR(porosity_after(m, n_0, 0.0, 42.0, flux), n_max - 0.1 * std::exp(-4.0 * flux * 40.0),
              1e-15);
  EXPECT_NEAR(erosion_rate(m, n_0, 42.0, flux), 4.0 * flux * 0.1, 1e-17);
}

TEST(FluxLaw, ErodesBeyondItsThresholdOnly) {
  ErosionModel m = model(erosion_law("flux"), 4.0);
  m.threshold = 0.005;
  EXPECT_EQ(porosity_after(m, n_0, 0.0, 42.0, 0.004), n_0);
  EXPECT_EQ(erosion_rate(m, n_0, 42.0, 0.004), 0.0);
  EXPECT_EQ(erosion_rate(m, n_0, 42.0, 0.005), 0.0);
  EXPECT_NEAR(erosion_rate(m, n_0, 42.0, flux), 4.0 * 0.007 * 0.1, 1e-17);
  EXPECT_NEAR(porosity_after(m, n_0, 0.0, 42.0, flux), n_max - 0.1 * std::exp(-4.0 * 0.007 * 40.0),
              1e-15);
  EXPECT_TRUE(std::isnan(porosity_after(m, n_0, 0.0, 42.0, unset)));
}

TEST(ConstantLaw, StartsAndEndsAtItsExactTimes) {
  const ErosionModel m = model(erosion_law("constant"), 1e-3);
  EXPECT_EQ(porosity_after(m, n_0, 0.0, 2.0, unset), n_0);
  EXPECT_GT(porosity_after(m, n_0, 0.0, 2.0 + 1e-9, unset), n_0);
  // 0.1 / 1e-3 = 100 s after the start.
  EXPECT_NEAR(exhaustion_time(m, n_0), 102.0, 1e-12);
  EXPECT_LT(porosity_after(m, n_0, 0.0, 102.0 - 1e-9, unset), n_max);
  EXPECT_EQ(porosity_after(m, n_0, 0.0, 102.0 + 1e-9, unset), n_max);
  EXPECT_EQ(porosity_after(m, n_0, 0.0, 1e6, unset), n_max);
  EXPECT_EQ(erosion_rate(m, n_0, 1.999, unset), 0.0);
  EXPECT_EQ(erosion_rate(m, n_0, 2.0, unset), 1e-3);
}

TEST(LogarithmicLaw, ApproachesItsCapWithoutPassingIt) {
  const ErosionModel m = model(erosion_law("logarithmic"), 1e-2);
  double n = n_0;
  for (double t = 10.0; t < 2000.0; t += 10.0) n = porosity_after(m, n, t - 10.0, t, unset);
  EXPECT_NEAR(n_max - n, 0.0, 1e-15);
  // A single step of a day.
  EXPECT_EQ(porosity_after(m, n_0, 0.0, 86400.0, unset), n_max);
}

}  // namespace erosion_law_test
}  // namespace suffuse

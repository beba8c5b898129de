/// The same case gives the same files on any number of threads; steps end at outputs.

#include <gtest/gtest.h>

#include <stdexcept>

#include "files/layout.hpp"
#include "files/number_text.hpp"
#include "results/reader.hpp"
#include "solver/solver_process.hpp"

namespace suffuse {
namespace determinism_test {

using test::Outcome;

/// A column of the history.
std::vector<double> column(const std::string& results, const std::string& name) {
  return ResultsReader(results).history().column(name);
}

class Determinism : public testing::TestWithParam<test::Mode> {
 protected:
  [[nodiscard]] std::string solve(const std::string& case_path, const std::string& name,
                                  const std::vector<std::string>& options = {}) const {
    const Outcome outcome = place_.solve(case_path, place_.path(name), options);
    if (outcome.code != 0) throw std::runtime_error(outcome.error);
    return place_.path(name);
  }

  test::Workplace place_;
};

TEST_P(Determinism, TwiceTheSameFiles) {
  const std::string case_path = place_.make_case(GetParam());
  const std::string once = solve(case_path, "once");
  EXPECT_EQ(test::difference(solve(case_path, "twice"), once), "");
}

/// There are enough elements that the loops are shared among threads (parallel.hpp).
TEST_P(Determinism, OneAndTwoThreadsGiveTheSameFiles) {
  const bool is_explicit = GetParam().name.find("implicit") == std::string::npos;
  const bool is_double = GetParam().name.starts_with("double");
  const bool is_moving = GetParam().name.starts_with("moving");
  const std::string end = is_explicit ? "0.004" : "0.4";
  const test::Mode large = test::with(
      GetParam(), "large",
      {"mesh.size=" + std::string(is_double   ? "0.0075"
                                  : is_moving ? "0.014"
                                              : "0.01"),
       "soil.specimen.erosion.start=0", "time.end=" + end,
       "time.step=" + std::string(is_explicit ? "0.0002" : "0.1"),
       "output={every = " + end + ", snapshot_every = " + end + "}", "time.mass_scaling=1e2"});
  test::Mode mode = large;
  if (!is_explicit) mode.sets.pop_back();
  const std::string case_path = place_.make_case(mode);
  const std::string one = solve(case_path, "one", {"--threads", "1"});
  EXPECT_EQ(test::difference(solve(case_path, "two", {"--threads", "2"}), one), "");
}

/// Each row is the state at the end of a step, at exactly the requested time.
TEST_P(Determinism, StepsEndOnOutputs) {
  const bool moves = GetParam().name == test::moving_mode().name;
  const auto every = [&](const std::string& name, double rows) {
    const std::string output = "output={every = " + number_text(rows) + ", snapshot_every = 2.0}";
    std::vector<std::string> sets{output, "time.end=4.0"};
    if (moves) sets.emplace_back("time.tolerance=1e-4");
    return solve(place_.make_case(test::with(GetParam(), name, sets)), name);
  };
  const std::string often = every("often", 0.125);
  const std::string seldom = every("seldom", 1.0);
  const std::vector<double> times = column(often, "t");
  ASSERT_EQ(times.size(), 33U);
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_EQ(times[k], 0.125 * static_cast<double>(k));
  }
  // The steps differ, the run is the same.
  const std::vector<double> porosity = column(often, "porosity_mean");
  const std::vector<double> same = column(seldom, "porosity_mean");
  ASSERT_EQ(same.size(), 5U);
  // Steps of soil that moves, which take its conductivities at their start, differ by less than the
  // tolerance.
  const double apart = moves ? 1e-4 : 1e-5;
  for (std::size_t k = 0; k < same.size(); ++k) EXPECT_NEAR(porosity[8 * k], same[k], apart);
}

std::string name_of(const testing::TestParamInfo<test::Mode>& info) {
  return info.param.name;
}
std::vector<test::Mode> modes() {
  std::vector<test::Mode> result = test::five_modes();
  result.push_back(test::moving_mode());
  return result;
}
INSTANTIATE_TEST_SUITE_P(Modes, Determinism, testing::ValuesIn(modes()), name_of);

}  // namespace determinism_test
}  // namespace suffuse

/// The same case gives the same files on any number of threads, and more outputs show the same run.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "results/layout.hpp"
#include "results/number_text.hpp"
#include "results/restart_point.hpp"
#include "solver/solver_process.hpp"

namespace suffuse {
namespace {

using test::Outcome;

/// Lines of a table by what stands before the first comma, the time; several for tables of regions.
std::map<std::string, std::string> lines_by_time(const std::string& path) {
  std::istringstream in(test::read_file(path));
  std::map<std::string, std::string> lines;
  for (std::string line; std::getline(in, line);) {
    lines[line.substr(0, line.find(','))] += line + "\n";
  }
  return lines;
}

/// What run.json says of the work that was done.
nlohmann::json account(const std::string& results) {
  const auto info = nlohmann::json::parse(test::read_file(results + "/" + layout::run_info));
  nlohmann::json said = {{"steps", info.at("steps")}, {"points", info.at("liquid_points")}};
  for (const auto& pass : info.at("passes")) said[pass.at("name")] = pass.at("calls");
  return said;
}

/// The state of the whole run that the last snapshot keeps.
std::vector<std::uint8_t> last_state(const std::string& results) {
  const int last = test::snapshots_in(results) - 1;
  const std::string file = results + "/" + layout::snapshot("mesh", last);
  return read_restart_point(file).value().state;
}

/// All but the two counters of outputs, 18 bytes in one place.
void expect_same_state(const std::vector<std::uint8_t>& one,
                       const std::vector<std::uint8_t>& other) {
  ASSERT_EQ(one.size(), other.size());
  ASSERT_GT(one.size(), 10000U);
  const auto first = std::ranges::mismatch(one, other).in1 - one.begin();
  const auto last =
      std::mismatch(one.rbegin(), one.rend(), other.rbegin()).first.base() - one.begin();
  EXPECT_GT(last - first, 0) << "the counters";
  EXPECT_LE(last - first, 18);
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

/// Enough elements that the loops are shared among threads (parallel.hpp), for a few steps.
TEST_P(Determinism, OneAndTwoThreadsGiveTheSameFiles) {
  const bool is_explicit = GetParam().name.find("implicit") == std::string::npos;
  const bool is_double = GetParam().name.starts_with("double");
  const std::string end = is_explicit ? "0.004" : "0.4";
  const test::Mode large = test::with(
      GetParam(), "large",
      {"mesh.size=" + std::string(is_double ? "0.0075" : "0.01"), "soil.specimen.erosion.start=0",
       "time.end=" + end, "time.step=" + std::string(is_explicit ? "0.0002" : "0.1"),
       "output={every = " + end + ", snapshot_every = " + end + "}", "time.mass_scaling=1e2"});
  test::Mode mode = large;
  if (!is_explicit) mode.sets.pop_back();
  const std::string case_path = place_.make_case(mode);
  const std::string one = solve(case_path, "one", {"--threads", "1"});
  EXPECT_EQ(test::difference(solve(case_path, "two", {"--threads", "2"}), one), "");
}

TEST_P(Determinism, OutputsDoNotChangeTheRun) {
  // Times that binary numbers have exactly, so that those in common are the same to the last digit.
  const double unit = GetParam().name == "single_point_explicit" ? 1.0 / 128.0 : 1.0 / 16.0;
  const auto every = [&](const std::string& name, double rows, double snapshots) {
    const std::string output = "output={every = " + number_text(rows) +
                               ", snapshot_every = " + number_text(snapshots) + "}";
    const std::string end = "time.end=" + number_text(64.0 * unit);
    return solve(place_.make_case(test::with(GetParam(), name, {output, end})), name);
  };
  const std::string often = every("often", unit, 4.0 * unit);
  const std::string seldom = every("seldom", 8.0 * unit, 32.0 * unit);
  EXPECT_EQ(account(often), account(seldom)) << "steps and calls of all passes";
  expect_same_state(last_state(often), last_state(seldom));
  for (const char* table : {layout::history, layout::ledger, layout::regions}) {
    const auto all = lines_by_time(often + "/" + table);
    const auto few = lines_by_time(seldom + "/" + table);
    EXPECT_EQ(all.size(), 66U) << "names and rows";
    EXPECT_EQ(few.size(), 10U);
    for (const auto& [time, lines] : few) EXPECT_EQ(all.at(time), lines) << table;
  }
}

std::string name_of(const testing::TestParamInfo<test::Mode>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Modes, Determinism, testing::ValuesIn(test::five_modes()), name_of);

}  // namespace
}  // namespace suffuse

/// Runs every input of corpus/ and findings/ once: earlier findings stay fixed, and inputs that
/// reach all parts of the code still pass.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bytes.hpp"
#include "case/case_file.hpp"
#include "driver/plan.hpp"
#include "edited_files.hpp"
#include "formulation/two_phase_model.hpp"
#include "results/reader.hpp"
#include "targets.hpp"
#include "test_paths.hpp"

namespace suffuse::fuzz {
namespace replay_test {

namespace fs = std::filesystem;

std::vector<fs::path> inputs_of(const std::string& target) {
  std::vector<fs::path> inputs;
  for (const std::string kind : {"corpus", "findings"}) {
    const fs::path folder = fs::path(test::source_folder()) / "tests/fuzz" / kind / target;
    if (!fs::is_directory(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder)) inputs.push_back(entry.path());
  }
  std::ranges::sort(inputs);
  return inputs;
}

class Replay : public testing::TestWithParam<std::string> {};

TEST_P(Replay, EveryInputIsTakenOrRefused) {
  static const std::map<std::string, void (*)(const std::string&)> targets{
      {"scene", try_scene},
      {"geometry", try_geometry},
      {"case", try_case},
      {"results", try_results},
      {"model", try_model}};
  const std::vector<fs::path> inputs = inputs_of(GetParam());
  EXPECT_GE(inputs.size(), 3U);
  for (const fs::path& input : inputs) {
    EXPECT_NO_THROW(targets.at(GetParam())(file_bytes(input.string()))) << input;
  }
}

template <int Dim>
void expect_to_run(const std::string& path) {
  const Case<Dim> c = read_case<Dim>(path);
  const auto model = make_model(c, make_plan(c, {}));
  model->advance(0.1 * c.document.scene.time.end);
  EXPECT_GT(model->time(), 0.0);
}

/// Edits of a seed that is refused anyway would test nothing.
TEST(Seeds, AreValid) {
  int in_space = 0;
  for (const std::string& name : names(case_seeds())) {
    SCOPED_TRACE(name);
    const std::string path = lay_out_case("seed " + name);
    const bool box = read_case_dimension(path) == 3;
    EXPECT_NO_THROW(box ? expect_to_run<3>(path) : expect_to_run<2>(path));
    if (box) ++in_space;
  }
  EXPECT_EQ(in_space, 2);
  for (const std::string& name : names(results_seeds())) {
    SCOPED_TRACE(name);
    const ResultsReader results(lay_out_results("seed " + name));
    EXPECT_GE(results.times().size(), 2U);
    for (const std::string kind : {"cell", "node", "element_vertex", "solid"}) {
      for (const std::string& field : results.field_names(0, kind)) {
        EXPECT_FALSE(results.field(0, kind, field).values.empty()) << field;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, Replay,
                         testing::Values("scene", "geometry", "case", "results", "model"),
                         [](const auto& tested) { return tested.param; });

}  // namespace replay_test
}  // namespace suffuse::fuzz

/// What fuzzing has found before stays dealt with, and so does all that reaches new places: every
/// input of corpus/ and findings/, once.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bytes.hpp"
#include "targets.hpp"

namespace suffuse::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> inputs_of(const std::string& target) {
  std::vector<fs::path> inputs;
  for (const std::string kind : {"corpus", "findings"}) {
    const fs::path folder = fs::path(SUFFUSE_SOURCE_DIR) / "tests/fuzz" / kind / target;
    if (!fs::is_directory(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder)) inputs.push_back(entry.path());
  }
  std::ranges::sort(inputs);
  return inputs;
}

class Replay : public testing::TestWithParam<std::string> {};

TEST_P(Replay, EveryInputIsTakenOrRefused) {
  static const std::map<std::string, void (*)(const std::string&)> targets{
      {"scene", try_scene}, {"case", try_case}, {"results", try_results}, {"model", try_model}};
  const std::vector<fs::path> inputs = inputs_of(GetParam());
  EXPECT_GE(inputs.size(), 3U);
  for (const fs::path& input : inputs) {
    EXPECT_NO_THROW(targets.at(GetParam())(file_bytes(input.string()))) << input;
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, Replay, testing::Values("scene", "case", "results", "model"),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace suffuse::fuzz

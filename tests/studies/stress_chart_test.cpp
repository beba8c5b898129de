#include "studies/stress_chart.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/errors.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace stress_chart_test {

using testing::ScratchFolder;

std::vector<SweepCount> read(const std::string& table) {
  const ScratchFolder scratch;
  std::ofstream(scratch / "stress.csv") << table;
  return read_sweep_counts(scratch / "stress.csv");
}

TEST(SweepCounts, AreCountedBySweepInTheOrderOfTheFile) {
  const auto sweeps = read(
      "scheme,sweep,verdict\n"
      "a,step,pass\na,step,refused\na,drying,failed\na,step,pass\n");
  ASSERT_EQ(sweeps.size(), 2U);
  EXPECT_EQ(sweeps[0].sweep, "step");
  EXPECT_EQ(sweeps[0].pass, 2);
  EXPECT_EQ(sweeps[0].refused, 1);
  EXPECT_EQ(sweeps[0].failed, 0);
  EXPECT_EQ(sweeps[1].failed, 1);
}

TEST(SweepCounts, OtherTablesAreRefused) {
  EXPECT_THROW(read("sweep,scheme\na,b\n"), FileError);
  EXPECT_THROW(read("sweep,verdict\na\n"), FileError);
  try {
    read("sweep,verdict\na,passed\n");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("stress.csv:2: verdict: got \"passed\"; expected"), std::string::npos)
        << message;
    EXPECT_TRUE(message.ends_with("did you mean pass?")) << message;
  }
}

TEST(StressChart, ShowsEverySweepAndItsNumbers) {
  const ScratchFolder scratch;
  const std::string path = scratch / "stress.svg";
  draw_stress_chart({{"step", 80, 28, 0}, {"drying", 160, 0, 2}}, path);
  std::ifstream in(path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  for (const char* word :
       {">step<", ">drying<", ">80<", ">28<", ">160<", ">refused<", ">2 failed<"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word;
  }
}

}  // namespace stress_chart_test
}  // namespace suffuse

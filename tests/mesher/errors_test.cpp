#include "common/errors.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <system_error>

namespace suffuse {
namespace errors_test {

struct Outcome {
  int code;
  std::string printed;
};

template <class Body>
Outcome outcome_of(Body body) {
  testing::internal::CaptureStderr();
  const int code = run_program("program", body);
  return {code, testing::internal::GetCapturedStderr()};
}

template <class Error>
Outcome outcome_of_throwing(const Error& error) {
  return outcome_of([&error]() -> int { throw error; });
}

TEST(InputProblem, leaves_out_empty_parts) {
  EXPECT_EQ((InputProblem{"a.toml:3", "mesh.size", "0", "h > 0", "mesh.size"}.message()),
            "a.toml:3: mesh.size: got 0; expected h > 0; did you mean mesh.size?");
  EXPECT_EQ((InputProblem{"a.toml:3", "mesh.size", "", "h > 0", ""}.message()),
            "a.toml:3: mesh.size: expected h > 0");
  EXPECT_EQ((InputProblem{"", "mesh.size", "", "", ""}.message()), "mesh.size");
}

TEST(RunProgram, returns_what_its_body_returns) {
  const Outcome outcome = outcome_of([] { return 7; });
  EXPECT_EQ(outcome.code, 7);
  EXPECT_EQ(outcome.printed, "");
}

TEST(RunProgram, prints_all_problems_of_the_input) {
  const Outcome outcome = outcome_of_throwing(InputError(
      std::vector<InputProblem>{{"f:1", "a", "1", "2", ""}, {"f:2", "b", "3", "4", ""}}));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.printed, "f:1: a: got 1; expected 2\nf:2: b: got 3; expected 4\n");
}

TEST(RunProgram, prints_a_sentence_under_its_name) {
  const Outcome outcome = outcome_of_throwing(InputError("two scenes given"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.printed, "program: error: two scenes given\n");
}

TEST(RunProgram, has_an_exit_code_for_each_kind_of_failure) {
  const Outcome numerical = outcome_of_throwing(NumericalError("unstable"));
  EXPECT_EQ(numerical.code, 3);
  EXPECT_EQ(numerical.printed, "program: error: unstable\n");
  const Outcome file = outcome_of_throwing(FileError("no room"));
  EXPECT_EQ(file.code, 4);
  EXPECT_EQ(file.printed, "program: error: no room\n");
  const Outcome system = outcome_of_throwing(std::filesystem::filesystem_error(
      "status", "a/b", std::make_error_code(std::errc::filename_too_long)));
  EXPECT_EQ(system.code, 4);
  EXPECT_EQ(system.printed, "program: error: a/b: File name too long\n");
  const Outcome memory = outcome_of_throwing(std::bad_alloc());
  EXPECT_EQ(memory.code, 3);
  EXPECT_NE(memory.printed.find("out of memory"), std::string::npos);
}

TEST(RunProgram, calls_anything_else_a_bug) {
  const Outcome logic = outcome_of_throwing(std::logic_error("index 7"));
  EXPECT_EQ(logic.code, 3);
  EXPECT_NE(logic.printed.find("bug in Suffuse"), std::string::npos);
  EXPECT_NE(logic.printed.find("index 7"), std::string::npos);
  EXPECT_EQ(outcome_of_throwing(42).code, 3);
}

}  // namespace errors_test
}  // namespace suffuse

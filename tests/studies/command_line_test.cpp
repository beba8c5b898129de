#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "post/synthetic_results.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace command_line_test {

using testing::file_text;
using testing::ScratchFolder;

/// A folder with the table of a study.
class StudiesCommand : public ::testing::Test {
 protected:
  /// Exit code; what the program writes to stderr lands in `message`.
  int studies(const std::string& arguments) {
    const std::string command = std::string("env -u DISPLAY ") + test::program_folder() +
                                "/suffuse-studies " + arguments + " > " + scratch / "out.txt" +
                                " 2> " + scratch / "error.txt";
    const int status = std::system(command.c_str());
    message = file_text(scratch / "error.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  const ScratchFolder scratch;
  const std::string table = scratch / "table.csv";
  std::string message;
};

TEST_F(StudiesCommand, DrawsTheAccuracyOfAProblem) {
  std::ofstream(table) << "problem,scheme,quantity,error_l1,seconds\n"
                       << "dam,sp-implicit,porosity,1e-3,0.5\n";
  const std::string picture = scratch / "dam.png";
  EXPECT_EQ(studies("accuracy " + table + " --problem dam -o " + picture), 0) << message;
  EXPECT_TRUE(std::filesystem::exists(picture));
  EXPECT_EQ(studies("accuracy " + table + " --problem dm -o " + picture), 2);
  EXPECT_EQ(message,
            "suffuse-studies accuracy: --problem: got \"dm\"; expected \"dam\"; did you mean "
            "dam?\n");
  EXPECT_EQ(studies("accuracy " + table + " -o " + picture), 2) << "without a problem";
}

TEST_F(StudiesCommand, DrawsTheVerdictsOfTheStressStudy) {
  std::ofstream(table) << "sweep,verdict\nstep,pass\n";
  const std::string picture = scratch / "stress.svg";
  EXPECT_EQ(studies("stress " + table + " -o " + picture), 0) << message;
  EXPECT_NE(file_text(picture).find(">step<"), std::string::npos);
  EXPECT_EQ(studies("stress " + table + " -o stress.jpg"), 2);
  EXPECT_EQ(message,
            "suffuse-studies stress: -o: got \"stress.jpg\"; expected a name that ends in .png, "
            ".svg or .pdf\n");
  EXPECT_EQ(studies("stress " + scratch / "none.csv" + " -o " + picture), 4);
}

TEST_F(StudiesCommand, KnowsNoOtherCommands) {
  EXPECT_EQ(studies(""), 2);
  EXPECT_EQ(studies("ledger"), 2);
  EXPECT_EQ(studies("--help"), 0);
}

}  // namespace command_line_test
}  // namespace suffuse

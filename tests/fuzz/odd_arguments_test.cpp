/// Programs that get wrong files: each ends by itself, with the documented exit code and a message
/// that begins with its own name or that of the file.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "bytes.hpp"
#include "mesher/temporary_folder.hpp"
#include "test_paths.hpp"

namespace suffuse::fuzz {
namespace odd_arguments_test {

struct Outcome {
  int code = -1;  // 128 and the signal's number where one ended it
  std::string text;
};

/// Runs a command in `folder`, for 60 seconds at most, without input.
Outcome run(const std::string& folder, const std::vector<std::string>& words) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return {};
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
    ::dup2(ends[1], STDOUT_FILENO);
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[0]);
    if (::chdir(folder.c_str()) != 0) ::_exit(99);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::alarm(60);
    ::execv(arguments.front(), arguments.data());
    ::_exit(99);
  }
  ::close(ends[1]);
  Outcome outcome;
  std::array<char, 4096> block{};
  for (ssize_t n = 0; (n = ::read(ends[0], block.data(), block.size())) > 0;) {
    outcome.text.append(block.data(), static_cast<std::size_t>(n));
  }
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

const std::string mesher = test::program_folder() + "/suffuse-mesher";
const std::string solver = test::program_folder() + "/suffuse-solver";
const std::string post = test::program_folder() + "/suffuse-post";

std::string name_of(const std::string& program) {
  return program.substr(program.rfind('/') + 1);
}

class OddArguments : public testing::Test {
 protected:
  OddArguments() {
    std::filesystem::create_directory(folder_.path() / "folder");
    folder_.write("text", "hello\n");
    folder_.write("empty", "");
    folder_.write(not_utf8, "x");
    folder_.write("nul", std::string("\0\0\0", 3));
    ::mkfifo(folder_.file("pipe").c_str(), 0600);
    H5Fclose(H5Fcreate(folder_.file("other.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
    files_ = folder_.count();
  }

  void expect_refusal(const std::string& program, const std::vector<std::string>& arguments) {
    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const Outcome outcome = run(folder_.path().string(), words);
    std::string all = name_of(program);
    for (const std::string& argument : arguments) all += " '" + argument.substr(0, 40) + "'";
    SCOPED_TRACE(all + "\n" + outcome.text.substr(0, 400));
    EXPECT_TRUE(outcome.code == 2 || outcome.code == 4) << outcome.code;
    const bool under_name = outcome.text.starts_with(name_of(program) + ": error: ");
    const bool under_place =
        !arguments.empty() &&
        (outcome.text.starts_with(arguments.front() + ":") || outcome.text.starts_with("--set "));
    EXPECT_TRUE(under_name || under_place);
    EXPECT_EQ(outcome.text.find("bug in Suffuse"), std::string::npos);
    EXPECT_EQ(folder_.count(), files_);
  }

  static constexpr const char* not_utf8 = "\xff\xfe.case.h5";
  test::TemporaryFolder folder_;
  int files_ = 0;
};

std::vector<std::string> odd_names() {
  std::string deep = std::string(200, 'b');
  for (int i = 0; i < 30; ++i) deep += "/" + std::string(200, 'b');
  return {"",
          ".",
          "..",
          "/",
          "folder",
          "folder/",
          "text",
          "text/",
          "empty",
          "nul",
          "other.h5",
          "nowhere",
          "/dev/null",
          "/proc/self/mem",
          "a\nb",
          "\x1b[2J",
          "\xff\xfe.case.h5",
          std::string(5000, 'a'),
          deep,
          "~",
          "-"};
}

TEST_F(OddArguments, AreNoScenes) {
  // Only a few files, because Gmsh takes long to start.
  for (const std::string& name :
       {std::string(), std::string("folder"), std::string("nul"), std::string("other.h5"),
        std::string("/proc/self/mem"), std::string("\xff\xfe.case.h5"), std::string(5000, 'a')}) {
    expect_refusal(mesher, {name});
  }
}

TEST_F(OddArguments, AreNoCases) {
  for (const std::string& name : odd_names()) expect_refusal(solver, {name});
  expect_refusal(solver, {"pipe"});
}

TEST_F(OddArguments, AreNoResults) {
  for (const std::string& name : odd_names()) expect_refusal(post, {"ledger", name});
  expect_refusal(post, {"ledger", "pipe"});
}

TEST_F(OddArguments, AreNoOptions) {
  for (const std::string& program : {mesher, solver, post}) {
    for (const std::string word : {"--nope", "-o"}) {
      expect_refusal(program, {word});
    }
    expect_refusal(program, {});
  }
  for (const std::string number : {"0", "-1", "x", "1e9", "", "99999999999999999999"}) {
    expect_refusal(solver, {"text", "--threads", number});
  }
  expect_refusal(solver, {"text", "second"});
  expect_refusal(solver, {"text", "-o", ""});
  expect_refusal(mesher, {"text", "-o", ""});
}

TEST_F(OddArguments, AreToldOfAlikeByAllPrograms) {
  const auto error = [&](const std::string& program, const std::vector<std::string>& arguments) {
    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run(folder_.path().string(), words).text;
  };
  EXPECT_EQ(error(mesher, {"text", "--outptu", "x"}),
            "suffuse-mesher: error: got \"--outptu\"; expected an option of suffuse-mesher (see "
            "--help); did you mean --output?\n");
  EXPECT_EQ(error(solver, {"text", "--forse"}),
            "suffuse-solver: error: got \"--forse\"; expected an option of suffuse-solver (see "
            "--help); did you mean --force?\n");
  EXPECT_EQ(error(post, {"ledger", "text", "--tolerence", "1"}),
            "suffuse-post: error: got \"--tolerence\"; expected an option of suffuse-post ledger "
            "(see --help); did you mean --tolerance?\n");
  EXPECT_EQ(error(post, {"legder", "text"}).substr(0, 35), "suffuse-post: error: got \"legder\"; ");
  EXPECT_EQ(error(solver, {"text", "--sizes", "./text"}),
            "suffuse-solver: error: --sizes ./text would overwrite the case; name another file\n");
  EXPECT_EQ(error(solver, {"text", "second"}),
            "suffuse-solver: error: got \"second\"; expected no more arguments of suffuse-solver "
            "(see --help)\n");
}

TEST_F(OddArguments, HelpEndsWithTheExitCodes) {
  for (const std::string& program : {solver, post}) {
    const Outcome outcome = run(folder_.path().string(), {program, "--help"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.text.find("\nExit codes: 0 done, 2 wrong input, 3 "), std::string::npos)
        << outcome.text;
  }
}

}  // namespace odd_arguments_test
}  // namespace suffuse::fuzz

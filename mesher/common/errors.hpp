#pragma once

/// Errors that end a program: each kind has an exit code.

#include <stdexcept>
#include <string>
#include <vector>

namespace suffuse {

/// Exit codes of all three programs.
enum class ExitCode : int {
  done = 0,
  wrong_input = 2,        ///< the scene, the mesh or the command line is wrong
  numerical_failure = 3,  ///< the run failed numerically
  file_failure = 4,       ///< a file could not be read or written
  interrupted = 130,
};

/// One problem of the user's input. Prints as
/// `WHERE: KEY: got FOUND; expected EXPECTED; did you mean SUGGESTION?`
/// where WHERE is `FILE:LINE` (or `--set KEY=VALUE`), and empty parts are left out.
struct InputProblem {
  std::string where{};
  std::string key{};
  std::string found{};
  std::string expected{};
  std::string suggestion{};

  [[nodiscard]] std::string message() const;
};

/// All problems of the input. `what()` has one problem per line.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<InputProblem> problems);
  explicit InputError(InputProblem problem);
  /// A single problem that is one sentence, with no key (a command line, a mesh).
  explicit InputError(const std::string& sentence);
  [[nodiscard]] const std::vector<InputProblem>& problems() const { return problems_; }

 private:
  std::vector<InputProblem> problems_;
};

/// The computation could not continue: the message says where and what to do.
class NumericalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file could not be read or written, or is not what its name says.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Opens /dev/null for each of stdin, stdout and stderr that is closed: otherwise a file opened
/// later would get its number, and its messages. Ignores SIGXFSZ: a write beyond the largest file
/// size then fails and does not end the program.
void prepare_process();

/// Runs `body`, prints what it throws to stderr as `PROGRAM: error: ...` (an InputError's problems
/// one per line, as they are) and returns the exit code.
int run_program(const std::string& program, const auto& body);

/// Prints the exception now being handled, unless `silent`, and returns its exit code.
int report_current_exception(const std::string& program, bool silent = false);

int run_program(const std::string& program, const auto& body) {
  try {
    prepare_process();
    return body();
  } catch (...) {
    return report_current_exception(program);
  }
}

}  // namespace suffuse

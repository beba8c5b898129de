#pragma once

/// Runs a program as a user would, with a limit of processor time.

#include <string>
#include <vector>

namespace suffuse::stress {

struct ChildEnd {
  int exit_code = -1;  ///< -1: ended by a signal
  int signal = 0;
  bool timed_out = false;
  double seconds = 0.0;  ///< of processor time
  std::string output;    ///< what it wrote to standard output and error
};

/// `arguments` begins with the program; its output goes through the file `log`.
ChildEnd run_child(const std::vector<std::string>& arguments, const std::string& log,
                   double max_seconds);

}  // namespace suffuse::stress

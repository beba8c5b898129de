#pragma once

/// Measures the time that a pass of the solver takes.

#include <chrono>
#include <string>

namespace suffuse {

/// Cost of one pass of the solver.
struct PassTiming {
  std::string name;
  long calls = 0;
  double seconds = 0.0;
};

/// Adds its lifetime to the time of a pass.
class PassTimer {
 public:
  explicit PassTimer(PassTiming& pass) : pass_(pass), start_(std::chrono::steady_clock::now()) {}
  PassTimer(const PassTimer&) = delete;
  PassTimer& operator=(const PassTimer&) = delete;
  ~PassTimer() {
    pass_.seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  PassTiming& pass_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace suffuse

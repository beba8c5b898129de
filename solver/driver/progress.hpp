#pragma once

/// Progress of a run, on stderr: a bar on a terminal, otherwise a line every few seconds, nothing
/// when quiet.

#include <chrono>
#include <string>

namespace suffuse {

class Progress {
 public:
  Progress(double end, bool quiet);

  /// Simulated time and length of the last step, s. May be called after every interval: most calls
  /// print nothing.
  void report(double time, double dt);
  /// Prints a line without breaking the bar, also when quiet.
  void say(const std::string& line);
  /// Removes the bar.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void draw_bar(double time, double dt, double left) const;

  double end_;
  bool quiet_;
  bool terminal_;
  bool bar_shown_ = false;
  Clock::time_point start_;
  Clock::time_point last_;
};

}  // namespace suffuse

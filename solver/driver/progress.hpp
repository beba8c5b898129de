#pragma once

/// Progress of a run, on stderr: a bar on a terminal, otherwise a line every few seconds, nothing
/// when quiet.

#include <chrono>
#include <optional>
#include <string>

#include "driver/time_left.hpp"

namespace suffuse {

/// Progress of a run at one time.
struct Standing {
  double time = 0.0;                ///< simulated, s
  double end = 0.0;                 ///< of the run, s
  double step = 0.0;                ///< length of the last step, s
  double first_step = 0.0;          ///< of this process, s
  bool from_rest = false;           ///< the run started from rest in this process
  std::optional<double> time_left;  ///< wall time, s, if known
  bool soil_fails = false;          ///< soil fails, and steps are short
};

/// "3:20 left", or why that is unknown: "starting from rest: steps grow from 1e-10 s".
std::string outlook(const Standing& standing);

class Progress {
 public:
  /// `start` and `end`: simulated times between which this process runs, s; `from_rest`: the flow
  /// is at rest at the start.
  Progress(double start, double end, bool from_rest, bool quiet);

  /// Reports simulated time and length of the last step, s, and whether soil fails. To be called
  /// after every interval; most calls print nothing.
  void report(double time, double dt, bool soil_fails);
  /// Prints a line without breaking the bar, also when quiet.
  void say(const std::string& line);
  /// Removes the bar.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void draw_bar() const;

  Standing standing_;
  TimeLeft time_left_;
  bool quiet_;
  bool terminal_;
  bool bar_shown_ = false;
  Clock::time_point start_;
  Clock::time_point reported_;       ///< time of the last report
  Clock::time_point last_;           ///< time of the last output
  Clock::duration in_failure_ = {};  ///< wall time while soil failed
};

}  // namespace suffuse

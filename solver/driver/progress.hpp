#pragma once

/// Tells the user how far a run is: a bar on a terminal, a plain line every few seconds elsewhere,
/// nothing when quiet. Writes to stderr.

#include <chrono>
#include <string>

namespace suffuse {

class Progress {
 public:
  Progress(double end, bool quiet);

  /// Simulated time reached and the step in force, s. Cheap enough to be called at every interval.
  void report(double time, double dt);
  /// A line of its own, warnings included, that does not break the bar. Not silenced by quiet.
  void say(const std::string& line);
  /// Ends the bar.
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

#pragma once

/// Remaining wall time of a run, when it can be estimated.

#include <optional>

namespace suffuse {

/// Estimates from the pace of the last stretch, about a fifth of the wall time. While steps grow,
/// as after a start from rest, this is wrong by orders of magnitude. The first estimate is
/// therefore given when two successive stretches had about the same pace.
class TimeLeft {
 public:
  /// `start`: simulated time at which this process starts, s; `end` of the run, s.
  TimeLeft(double start, double end) : end_(end), begin_{0.0, start} {}

  /// Remaining wall time, s; nothing if unknown. To be called after every interval. `elapsed`: wall
  /// time since the start, s, ascending; `time`: simulated time by then, s.
  std::optional<double> at(double elapsed, double time);

 private:
  struct Moment {
    double elapsed;  ///< wall time, s
    double time;     ///< simulated time, s
  };

  double end_;
  Moment begin_;                ///< start of the current stretch
  int intervals_ = 0;           ///< in the current stretch
  std::optional<double> pace_;  ///< of the stretch before: wall time per simulated time
  bool known_ = false;
};

}  // namespace suffuse

#pragma once

/// How long a run will still take, as soon as that can be told.

#include <optional>

namespace suffuse {

/// Guesses from the pace of the last stretch, about a fifth of the wall time. While steps grow,
/// as after a start from rest, such guesses are wrong by orders of magnitude: the first is given
/// when two stretches, one after the other, had about the same pace.
class TimeLeft {
 public:
  /// `start`: simulated time at which this process starts, s; `end` of the run, s.
  TimeLeft(double start, double end) : end_(end), begin_{0.0, start} {}

  /// Wall time that is left, s; nothing while that is unknown. To be asked after every interval.
  /// `elapsed`: wall time since the start, s, ascending; `time`: simulated time by then, s.
  std::optional<double> at(double elapsed, double time);

 private:
  struct Moment {
    double elapsed;  ///< wall time, s
    double time;     ///< simulated time, s
  };

  double end_;
  Moment begin_;                ///< of the stretch that is not over yet
  int intervals_ = 0;           ///< in it
  std::optional<double> pace_;  ///< of the stretch before it: wall time per simulated time
  bool known_ = false;
};

}  // namespace suffuse

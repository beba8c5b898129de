#pragma once

/// How long a run will still take, as soon as that can be told.

#include <optional>

namespace suffuse {

/// Guesses from how fast simulated time has advanced lately, since a moment at a quarter to half of
/// the wall time. While steps still grow, as after a start from rest, guesses are wrong by orders
/// of magnitude: one is given only where it agrees with the one that was made at that moment.
class TimeLeft {
 public:
  /// `start`: simulated time at which this process starts, s; `end` of the run, s.
  TimeLeft(double start, double end) : end_(end), middle_{0.0, start, {}}, latest_(middle_) {}

  /// Wall time that is left, s; nothing while that is unknown. To be asked after every interval.
  /// `elapsed`: wall time since the start, s, ascending; `time`: simulated time by then, s.
  std::optional<double> at(double elapsed, double time);

 private:
  struct Moment {
    double elapsed;               ///< wall time, s
    double time;                  ///< simulated time, s
    std::optional<double> total;  ///< wall time of the whole run as guessed then, s
  };

  double end_;
  Moment middle_;
  Moment latest_;  ///< becomes `middle_` when twice its wall time has elapsed
};

}  // namespace suffuse

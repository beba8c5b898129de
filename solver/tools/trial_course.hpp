#pragma once

/// The course of a trial run, and an estimate of the remaining steps.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace suffuse {

/// Progress of a trial at the end of an interval.
struct Mark {
  double time = 0.0;  ///< simulated, s
  double steps = 0.0;
  double seconds = 0.0;  ///< wall time
};

/// Steps per simulated second.
inline double step_rate(const Mark& from, const Mark& to) {
  return (to.steps - from.steps) / (to.time - from.time);
}

/// The course of a trial: its start and the end of every interval.
struct TrialCourse {
  std::vector<Mark> marks;

  /// The last mark that is not after `time`.
  [[nodiscard]] const Mark& at(double time) const {
    const auto after = std::upper_bound(marks.begin(), marks.end(), time,
                                        [](double t, const Mark& mark) { return t < mark.time; });
    return *std::prev(after);
  }
  [[nodiscard]] const Mark& last() const { return marks.back(); }
  /// The start of the later half, which represents the rest of the run better than the first half.
  [[nodiscard]] const Mark& half() const { return at(0.5 * last().time); }

  /// Number of steps from the last mark to `end`. The length of steps grows as a power of time, at
  /// most the first, found from the last two decades of time, up to `longest`.
  [[nodiscard]] double steps_to_go(double longest, double end) const {
    const double rate = step_rate(half(), last());
    const double middle = 0.5 * (half().time + last().time);
    const Mark& later = at(0.1 * last().time);
    const Mark& earlier = at(0.1 * later.time);
    double power = 0.0;
    if (later.steps > earlier.steps) {
      const double growth = step_rate(earlier, later) / step_rate(later, last());
      const double farther = (later.time + last().time) / (earlier.time + later.time);
      power = std::clamp(std::log(growth) / std::log(farther), 0.0, 1.0);
    }
    double steps = 0.0;
    for (double t = last().time; t < end; t *= 2.0) {
      const double there = rate * std::pow(1.5 * t / middle, -power);
      steps += std::max(there, 1.0 / longest) * std::min(t, end - t);
    }
    return steps;
  }
  /// Mean wall time of a step since the start, s.
  [[nodiscard]] double mean_seconds() const {
    return (last().seconds - marks.front().seconds) / last().steps;
  }
  /// Mean wall time of a step in the later half, s.
  [[nodiscard]] double seconds_per_step() const {
    return (last().seconds - half().seconds) / (last().steps - half().steps);
  }
};

}  // namespace suffuse

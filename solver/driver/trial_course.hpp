#pragma once

/// The course of a trial run, and what it says of the steps that are still to come.

#include <algorithm>
#include <iterator>
#include <vector>

namespace suffuse {

/// How far a trial was at the end of an interval.
struct Mark {
  double time = 0.0;  ///< simulated, s
  double steps = 0.0;
  double seconds = 0.0;  ///< of wall time
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
  /// The start of the later half. What comes before is not like what is to come.
  [[nodiscard]] const Mark& half() const { return at(0.5 * last().time); }

  /// Steps from the end of the trial to `end`. While the time doubles, steps grow by as much as in
  /// the later half of the trial, until they are `longest`.
  [[nodiscard]] double steps_to_go(double longest, double end) const {
    const Mark& quarter = at(0.5 * half().time);
    double rate = step_rate(half(), last());
    const bool shows_growth = half().steps > quarter.steps;
    const double change =
        shows_growth ? std::clamp(rate / step_rate(quarter, half()), 0.5, 1.0) : 1.0;
    double steps = 0.0;
    for (double t = last().time; t < end; t *= 2.0) {
      rate *= change;
      steps += std::max(rate, 1.0 / longest) * std::min(t, end - t);
    }
    return steps;
  }
  /// Of a step since the start.
  [[nodiscard]] double mean_seconds() const {
    return (last().seconds - marks.front().seconds) / last().steps;
  }
  /// Of a step in the later half.
  [[nodiscard]] double seconds_per_step() const {
    return (last().seconds - half().seconds) / (last().steps - half().steps);
  }
};

}  // namespace suffuse

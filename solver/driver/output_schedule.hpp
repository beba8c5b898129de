#pragma once

/// The output times of a run: of rows of the tables, and of snapshots. Every output time ends a
/// step of the flow.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "grid/field_values.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Times k * every up to the end, and the end. They are multiples, so round-off does not add up.
class OutputTimes {
 public:
  OutputTimes(double every, double end) : every_(every), end_(end) {}

  [[nodiscard]] double next() const {
    return is_same_time(multiple(), end_) ? end_ : std::min(multiple(), end_);
  }
  /// Whether the next time has come, within round-off.
  [[nodiscard]] bool is_due(double time) const {
    return !finished() && (next() <= time || is_same_time(next(), time));
  }
  [[nodiscard]] bool finished() const { return last_ >= end_; }
  /// Number of past times.
  [[nodiscard]] long past() const { return past_; }
  /// The end comes from the scene: a finished run may be restored with a later end.
  void archive(auto& archive) { archive(index_, past_, last_); }
  /// Whether the next time has come, within round-off; if so, advances to the following one.
  bool take(double time) {
    const bool due = is_due(time);
    if (due) advance();
    return due;
  }
  void advance() {
    last_ = next();
    ++past_;
    if (multiple() <= end_ || is_same_time(multiple(), end_)) ++index_;
  }
  /// Number of all times.
  [[nodiscard]] long count() const {
    OutputTimes rest = *this;
    // Starts shortly before the end, because there may be very many times.
    const long skipped = std::max(0L, static_cast<long>(end_ / every_) - 2 - index_);
    rest.index_ += skipped;
    rest.past_ += skipped;
    while (!rest.finished()) rest.advance();
    return rest.past_;
  }

 private:
  [[nodiscard]] double multiple() const { return static_cast<double>(index_) * every_; }

  double every_;
  double end_;
  long index_ = 0;  ///< of the next multiple
  long past_ = 0;
  double last_ = -1.0;  ///< the last past time, s; negative: none
};

/// The outputs of a scene, rows and snapshots; both are more frequent while soil fails.
class OutputSchedule {
 public:
  /// Outputs that are due at one time.
  struct Due {
    bool row = false;
    bool snapshot = false;
  };
  /// Past outputs of one kind.
  struct Past {
    long count = 0;
    double last = -1.0;  ///< time, s; negative: none
    void add(double time) {
      ++count;
      last = time;
    }
    void archive(auto& archive) { archive(count, last); }
  };

  explicit OutputSchedule(const Scene& scene)
      : rows_(scene.output.every, scene.time.end),
        snapshots_(scene.output.snapshot_every, scene.time.end),
        failure_every_(scene.output.failure_every) {}

  [[nodiscard]] bool finished() const { return rows_.finished() && snapshots_.finished(); }
  [[nodiscard]] const OutputTimes& rows() const { return rows_; }
  [[nodiscard]] const OutputTimes& snapshots() const { return snapshots_; }
  [[nodiscard]] const Past& past_rows() const { return past_rows_; }
  [[nodiscard]] const Past& past_snapshots() const { return past_snapshots_; }

  void archive(auto& archive) {
    archive(rows_, snapshots_, past_rows_, past_snapshots_, in_failure_);
  }

  /// Sets whether soil fails from `time`, s, on; `last_step` is the length of the last step, s. If
  /// `failure_every` is shorter than steps, each step is written and none is shortened: such a
  /// short step might not even change the time.
  void follow_failure(double time, bool fails, double last_step) {
    each_step_ = fails && failure_every_ && *failure_every_ < last_step;
    if (!failure_every_ || !fails || each_step_) {
      in_failure_ = none;
    } else if (in_failure_ == none) {
      const double multiple = std::floor(time / *failure_every_) + 1.0;
      in_failure_ = multiple * *failure_every_;
      if (is_same_time(in_failure_, time)) in_failure_ = (multiple + 1.0) * *failure_every_;
    }
  }

  /// Whether the next step is written because soil fails and `failure_every` is shorter than a
  /// step.
  [[nodiscard]] bool writes_each_step() const { return each_step_; }

  /// The next output time, s. Not to be called when finished.
  [[nodiscard]] double next() const {
    const double regular = rows_.finished()        ? snapshots_.next()
                           : snapshots_.finished() ? rows_.next()
                                                   : std::min(rows_.next(), snapshots_.next());
    return std::min(regular, in_failure_);
  }

  /// Outputs that are due at `time`; advances to the following ones.
  Due take(double time) {
    const bool in_failure = each_step_ || in_failure_ <= time ||
                            (in_failure_ != none && is_same_time(in_failure_, time));
    const Due due{rows_.take(time) || in_failure, snapshots_.take(time) || in_failure};
    if (due.row) past_rows_.add(time);
    if (due.snapshot) past_snapshots_.add(time);
    if (in_failure) in_failure_ = none;
    each_step_ = false;
    return due;
  }

 private:
  static constexpr double none = std::numeric_limits<double>::infinity();

  OutputTimes rows_;
  OutputTimes snapshots_;
  std::optional<double> failure_every_;  ///< s
  double in_failure_ = none;             ///< the next output while soil fails, s
  bool each_step_ = false;               ///< set before each step
  Past past_rows_;
  Past past_snapshots_;
};

}  // namespace suffuse

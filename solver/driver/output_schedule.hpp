#pragma once

/// The output times of a run: of rows of the tables, and of snapshots. Every output time ends a
/// step of the flow.

#include <algorithm>
#include <vector>

#include "case/scene.hpp"
#include "flow/flow_values.hpp"

namespace suffuse {

/// Times k * every up to the end, and the end itself. Multiples, not sums: no drift.
class OutputTimes {
 public:
  OutputTimes(double every, double end) : every_(every), end_(end) {}

  [[nodiscard]] double next() const {
    return is_same_time(multiple(), end_) ? end_ : std::min(multiple(), end_);
  }
  /// Whether the next time has come, but for round-off.
  [[nodiscard]] bool is_due(double time) const {
    return !finished() && (next() <= time || is_same_time(next(), time));
  }
  [[nodiscard]] bool finished() const { return last_ >= end_; }
  /// The time before `next`, s; negative: none.
  [[nodiscard]] double last() const { return last_; }
  /// Number of times that are past.
  [[nodiscard]] long past() const { return past_; }
  /// The end is that of the scene: a run that has reached it may be restored with a later one.
  void archive(auto& archive) { archive(index_, past_, last_); }
  void advance() {
    last_ = next();
    ++past_;
    if (multiple() <= end_) ++index_;
  }
  /// Number of all times.
  [[nodiscard]] long count() const {
    OutputTimes rest = *this;
    // Starts shortly before the end, as there may be very many times.
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
  double last_ = -1.0;  ///< the time before, s; negative: none
};

/// Both kinds of output of a scene.
class OutputSchedule {
 public:
  /// What is to be written at one time.
  struct Due {
    bool row = false;
    bool snapshot = false;
  };

  explicit OutputSchedule(const Scene& scene)
      : rows_(scene.output.every, scene.time.end),
        snapshots_(scene.output.snapshot_every, scene.time.end) {}

  [[nodiscard]] bool finished() const { return rows_.finished() && snapshots_.finished(); }
  [[nodiscard]] const OutputTimes& rows() const { return rows_; }
  [[nodiscard]] const OutputTimes& snapshots() const { return snapshots_; }

  void archive(auto& archive) { archive(rows_, snapshots_); }

  /// The next output time, s. Only before it is finished.
  [[nodiscard]] double next() const {
    return rows_.finished()        ? snapshots_.next()
           : snapshots_.finished() ? rows_.next()
                                   : std::min(rows_.next(), snapshots_.next());
  }

  /// What is due at `time`; moves on to the output after it.
  Due take(double time) {
    const Due due{rows_.is_due(time), snapshots_.is_due(time)};
    if (due.row) rows_.advance();
    if (due.snapshot) snapshots_.advance();
    return due;
  }

 private:
  OutputTimes rows_;
  OutputTimes snapshots_;
};

}  // namespace suffuse

#pragma once

/// The output times of a run: of rows of the tables, and of snapshots. Every output time ends a
/// step of the flow.

#include <algorithm>
#include <vector>

#include "case/scene.hpp"

namespace suffuse {

/// Times k * every up to the end, and the end itself. Multiples, not sums: no drift.
class OutputTimes {
 public:
  OutputTimes(double every, double end) : every_(every), end_(end) {}

  [[nodiscard]] double next() const { return std::min(static_cast<double>(index_) * every_, end_); }
  [[nodiscard]] bool finished() const { return finished_; }
  /// Number of times that are past.
  [[nodiscard]] long past() const { return index_; }
  void archive(auto& archive) { archive(index_, finished_); }
  void advance() {
    finished_ = next() >= end_;
    ++index_;
  }
  /// Number of all times.
  [[nodiscard]] long count() const {
    OutputTimes all(every_, end_);
    // Starts shortly before the end, as there may be very many times.
    all.index_ = std::max(0L, static_cast<long>(end_ / every_) - 2);
    while (!all.finished()) all.advance();
    return all.index_;
  }

 private:
  double every_;
  double end_;
  long index_ = 0;
  bool finished_ = false;
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
    const Due due{!rows_.finished() && rows_.next() <= time,
                  !snapshots_.finished() && snapshots_.next() <= time};
    if (due.row) rows_.advance();
    if (due.snapshot) snapshots_.advance();
    return due;
  }

 private:
  OutputTimes rows_;
  OutputTimes snapshots_;
};

}  // namespace suffuse

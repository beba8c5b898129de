#pragma once

/// When a run has something to write: rows of the tables, and snapshots.

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
  /// How many times are past.
  [[nodiscard]] long past() const { return index_; }
  void archive(auto& archive) { archive(index_, finished_); }
  void advance() {
    finished_ = next() >= end_;
    ++index_;
  }
  /// How many there are from the first to the last.
  [[nodiscard]] long count() const {
    OutputTimes all(every_, end_);
    // Close below the end at once: counting one by one takes as long as there are times.
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
  /// What is to be written at one moment.
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

  /// Not to be asked when finished.
  [[nodiscard]] double next() const {
    return rows_.finished()        ? snapshots_.next()
           : snapshots_.finished() ? rows_.next()
                                   : std::min(rows_.next(), snapshots_.next());
  }

  /// What is due at `time`, and goes on to what comes after.
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

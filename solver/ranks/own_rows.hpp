#pragma once

/// What of the elements, faces or nodes of a mesh this rank owns.

#include <ranges>

namespace suffuse {

/// A rank owns a contiguous range of rows. Those of other ranks that it holds too, next to its own,
/// lie before and behind them.
class OwnRows {
 public:
  /// All of `count` rows: of a program that is alone.
  explicit OwnRows(int count) : last_(count) {}

  /// The numbers of own rows, ascending.
  [[nodiscard]] auto own() const { return std::views::iota(first_, last_); }
  [[nodiscard]] bool owns(int row) const { return row >= first_ && row < last_; }

 private:
  int first_ = 0;
  int last_;
};

}  // namespace suffuse

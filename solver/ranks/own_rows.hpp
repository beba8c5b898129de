#pragma once

/// What of the elements, faces or nodes of a mesh this rank owns, and the copies that it holds of
/// those of other ranks.

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace suffuse {

/// The numbers from `first` on, up to but without `last`. (Clang 14 does not know the ranges of the
/// standard library that it is installed with.)
class NumberRange {
 public:
  class Iterator {
   public:
    explicit Iterator(int number) : number_(number) {}
    int operator*() const { return number_; }
    Iterator& operator++() {
      ++number_;
      return *this;
    }
    bool operator==(const Iterator&) const = default;

   private:
    int number_;
  };

  NumberRange(int first, int last) : first_(first), last_(last) {}
  [[nodiscard]] Iterator begin() const { return Iterator(first_); }
  [[nodiscard]] Iterator end() const { return Iterator(last_); }

 private:
  int first_;
  int last_;
};

/// Fetches what this rank holds copies of from the ranks that own it.
class Halo {
 public:
  Halo() = default;
  virtual ~Halo() = default;
  Halo(const Halo&) = delete;
  Halo& operator=(const Halo&) = delete;

  /// Overwrites the copies among `values`, of `bytes` each, one for each row that this rank holds.
  /// All ranks have to call it.
  virtual void exchange(void* values, std::size_t bytes) const = 0;
};

/// A rank owns a contiguous range of rows. Copies of other ranks' rows, those next to its own, lie
/// before and behind them, all in the order of the whole mesh.
class OwnRows {
 public:
  /// A program that is alone owns all of `count` rows.
  explicit OwnRows(int count = 0) : last_(count) {}
  OwnRows(int first, int last, std::shared_ptr<const Halo> halo)
      : first_(first), last_(last), halo_(std::move(halo)) {}

  /// The numbers of own rows, ascending.
  [[nodiscard]] NumberRange own() const { return {first_, last_}; }
  [[nodiscard]] bool owns(int row) const { return row >= first_ && row < last_; }

  /// Overwrites the copies with the values of their owners. Alone: does nothing.
  template <class Value>
  void exchange(std::vector<Value>& values) const {
    // Not is_trivially_copyable: vectors of Eigen are not, though their bytes are all they have.
    static_assert(std::is_standard_layout_v<Value> && std::is_trivially_destructible_v<Value>);
    if (halo_) halo_->exchange(values.data(), sizeof(Value));
  }
  /// Likewise for `size` values of each row, one after the other; `values` may have more behind.
  template <int size>
  void exchange_blocks(std::vector<double>& values) const {
    if (halo_) halo_->exchange(values.data(), size * sizeof(double));
  }

 private:
  int first_ = 0;
  int last_ = 0;
  std::shared_ptr<const Halo> halo_;  ///< null: alone
};

}  // namespace suffuse

#pragma once

/// Sums without round-off, so that they have the same bits in any order of the terms, and however
/// the terms are distributed to ranks.

#include <array>
#include <cstdint>

namespace suffuse {

/// The exact sum of any doubles (the small superaccumulator of Neal, arXiv:1505.05571): an integer
/// of 67 digits to the base 2^32, in units of 2^-1075. A term costs about 7 ns.
class ExactSum {
 public:
  void add(double term);
  void add(const ExactSum& other);
  /// The sum, rounded to the nearest double. A term that is not finite makes it that.
  [[nodiscard]] double value() const;
  /// The difference of two sums, rounded once.
  [[nodiscard]] double minus(const ExactSum& other) const;

  /// Equal sums have equal bytes.
  void archive(auto& archive) {
    carry();
    archive(digits_, not_finite_);
  }

 private:
  using Digits = std::array<std::int64_t, 67>;

  /// Brings all digits but the last into [0, 2^32).
  void carry();
  static void carry(Digits& digits);

  Digits digits_{};          ///< lowest first; they may be larger than the base, and negative
  double not_finite_ = 0.0;  ///< sum of terms that are not finite
  int terms_ = 0;            ///< since the last carry
};

}  // namespace suffuse

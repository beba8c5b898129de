#pragma once

#include <cmath>

namespace suffuse {

/// Sum of many numbers whose round-off does not grow with their count (Neumaier's summation). It
/// makes long balances close to 1e-12.
class CompensatedSum {
 public:
  static constexpr bool has_no_gaps = true;  ///< see StateArchive

  void add(double term) {
    const double sum = sum_ + term;
    const bool sum_is_larger = std::abs(sum_) >= std::abs(term);
    correction_ += sum_is_larger ? (sum_ - sum) + term : (term - sum) + sum_;
    sum_ = sum;
  }
  [[nodiscard]] double value() const { return sum_ + correction_; }
  /// The difference of two sums, with digits that each value alone cannot hold.
  [[nodiscard]] double minus(const CompensatedSum& other) const {
    return (sum_ - other.sum_) + (correction_ - other.correction_);
  }

 private:
  double sum_ = 0.0;
  double correction_ = 0.0;
};

}  // namespace suffuse

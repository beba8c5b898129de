#include "ranks/exact_sum.hpp"

#include <bit>
#include <cmath>

namespace suffuse {
namespace {

constexpr int digit_bits = 32;
constexpr std::int64_t digit_mask = 0xffffffff;
constexpr int mantissa_bits = 52;
constexpr int exponent_mask = 2047;
constexpr int unit_exponent = -1075;  ///< of the lowest digit
/// A term adds less than 2^52 to a digit, so that this many fit between two carries.
constexpr int most_terms = 1024;

}  // namespace

void ExactSum::add(double term) {
  const auto bits = std::bit_cast<std::uint64_t>(term);
  int exponent = static_cast<int>(bits >> mantissa_bits) & exponent_mask;
  auto mantissa = static_cast<std::int64_t>(bits & ((std::uint64_t{1} << mantissa_bits) - 1));
  if (exponent == exponent_mask) {
    not_finite_ += term;
    return;
  }
  if (exponent == 0) {
    exponent = 1;
  } else {
    mantissa |= std::int64_t{1} << mantissa_bits;
  }
  const int shift = exponent % digit_bits;
  const int digit = exponent / digit_bits;
  const auto low =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(mantissa) << shift) & digit_mask;
  const std::int64_t high = mantissa >> (digit_bits - shift);
  const bool is_negative = (bits >> 63) != 0;
  digits_[digit] += is_negative ? -low : low;
  digits_[digit + 1] += is_negative ? -high : high;
  if (++terms_ == most_terms) carry();
}

void ExactSum::add(const ExactSum& other) {
  carry();
  Digits digits = other.digits_;
  carry(digits);
  for (std::size_t i = 0; i < digits_.size(); ++i) digits_[i] += digits[i];
  carry();
  not_finite_ += other.not_finite_;
}

void ExactSum::carry() {
  carry(digits_);
  terms_ = 0;
}

void ExactSum::carry(Digits& digits) {
  for (std::size_t i = 0; i + 1 < digits.size(); ++i) {
    const std::int64_t above = digits[i] >> digit_bits;
    digits[i] &= digit_mask;
    digits[i + 1] += above;
  }
}

double ExactSum::value() const {
  if (not_finite_ != 0.0) return not_finite_;
  Digits digits = digits_;
  carry(digits);
  const bool is_negative = digits.back() < 0;
  if (is_negative) {
    for (std::int64_t& digit : digits) digit = -digit;
    carry(digits);
  }
  int top = static_cast<int>(digits.size()) - 1;
  while (top >= 0 && digits[top] == 0) --top;
  if (top < 0) return 0.0;
  // The highest 64 bits; the lowest of them is set, too, where a bit below is. The conversion to
  // double then rounds as all bits would.
  const auto digit = [&](int i) {
    return i < 0 ? std::uint64_t{0} : static_cast<std::uint64_t>(digits[i]);
  };
  std::uint64_t high = digit(top) << digit_bits | digit(top - 1);
  const int shift = std::countl_zero(high);
  bool rest = false;
  if (shift > 0) {
    high = high << shift | digit(top - 2) >> (digit_bits - shift);
    rest = (digit(top - 2) << shift & digit_mask) != 0;
  } else {
    rest = digit(top - 2) != 0;
  }
  for (int i = top - 3; i >= 0 && !rest; --i) rest = digits[i] != 0;
  if (rest) high |= 1;
  const int exponent = digit_bits * (top - 1) - shift + unit_exponent;
  const double magnitude = std::ldexp(static_cast<double>(high), exponent);
  return is_negative ? -magnitude : magnitude;
}

double ExactSum::minus(const ExactSum& other) const {
  ExactSum difference = *this;
  difference.carry();
  Digits digits = other.digits_;
  carry(digits);
  for (std::size_t i = 0; i < digits.size(); ++i) difference.digits_[i] -= digits[i];
  difference.not_finite_ -= other.not_finite_;
  return difference.value();
}

}  // namespace suffuse

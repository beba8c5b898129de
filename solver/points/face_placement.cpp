#include "points/face_placement.hpp"

#include <cmath>

namespace suffuse {
namespace {

/// Number in [0, 1) with the digits of `number` behind the point, in reverse order.
double radical_inverse(long number, int base) {
  double result = 0.0;
  double digit = 1.0 / base;
  for (long n = number; n > 0; n /= base, digit /= base) {
    result += digit * static_cast<double>(n % base);
  }
  return result;
}

/// Position on a segment before which the share `u` of a flux passes; its density is linear from
/// `at_begin` to `at_end`, both >= 0.
double share_along(double at_begin, double at_end, double u) {
  const double root = std::sqrt(at_begin * at_begin * (1.0 - u) + at_end * at_end * u);
  const double sum = at_begin + root;
  return sum > 0.0 ? u * (at_begin + at_end) / sum : u;
}

/// Position on a line from a corner of a triangle to the opposite side before which the share `u`
/// of a flux passes. Its linear density is weighted with the distance from the corner.
double share_from_corner(double at_corner, double at_side, double u) {
  if (at_corner == at_side) return std::sqrt(u);
  const double passed = u * (at_corner + 2.0 * at_side);
  double low = 0.0;
  double high = 1.0;
  for (int halving = 0; halving < 54; ++halving) {
    const double r = 0.5 * (low + high);
    const bool beyond = r * r * (at_corner * (3.0 - 2.0 * r) + 2.0 * at_side * r) > passed;
    (beyond ? high : low) = r;
  }
  return 0.5 * (low + high);
}

}  // namespace

template <int Directions>
std::array<double, Directions> even_numbers(long number, long face) {
  constexpr std::array<int, 2> base{2, 3};
  constexpr std::array<double, 2> turn{golden, 0.4142135623730950488};  // silver ratio - 2
  std::array<double, Directions> result;
  for (int d = 0; d < Directions; ++d) {
    const double x = radical_inverse(number + 1, base[d]) + turn[d] * static_cast<double>(face);
    result[d] = x - std::floor(x);
  }
  return result;
}

template <>
std::array<double, 2> spread_on_face(const std::array<double, 2>& inflow,
                                     const std::array<double, 1>& u) {
  const double s = share_along(inflow[0], inflow[1], u[0]);
  return {1.0 - s, s};
}

template <>
std::array<double, 3> spread_on_face(const std::array<double, 3>& inflow,
                                     const std::array<double, 2>& u) {
  // Chooses a line from the first node by its total flux, then a place on it.
  const double s = share_along(inflow[0] + 2.0 * inflow[1], inflow[0] + 2.0 * inflow[2], u[0]);
  const double r = share_from_corner(inflow[0], (1.0 - s) * inflow[1] + s * inflow[2], u[1]);
  return {1.0 - r, r * (1.0 - s), r * s};
}

template std::array<double, 1> even_numbers<1>(long, long);
template std::array<double, 2> even_numbers<2>(long, long);

}  // namespace suffuse

#pragma once

/// The tensor I + s d d^T, which differs from I in the direction d only. Soil with bedding conducts
/// differently across the bedding; fast flow resists changes along its direction most.

#include <algorithm>
#include <cmath>

#include "grid/element_field.hpp"

namespace suffuse {

/// Positive definite where s |d|^2 > -1.
template <int Dim>
struct DirectionalFactor {
  Vector<Dim> direction = Vector<Dim>::Zero();  ///< d; zero: the tensor is I
  double sign = -1.0;                           ///< s: 1 or -1

  [[nodiscard]] Vector<Dim> times(const Vector<Dim>& v) const {
    return v + sign * direction * direction.dot(v);
  }
  /// The inverse of the tensor times v.
  [[nodiscard]] Vector<Dim> inverse_times(const Vector<Dim>& v) const {
    return v - sign * direction * (direction.dot(v) / along_direction());
  }
  /// a . (s d d^T) . b
  [[nodiscard]] double excess(const Vector<Dim>& a, const Vector<Dim>& b) const {
    return sign * (direction.dot(a) * direction.dot(b));
  }
  /// The eigenvalue along d; all others are 1.
  [[nodiscard]] double along_direction() const { return 1.0 + sign * direction.squaredNorm(); }
  /// The tensor whose inverse is (1 - share) I + share (the inverse of this one): resistances with
  /// and without a direction add up.
  [[nodiscard]] DirectionalFactor beside_isotropic(double share) const {
    return {direction * std::sqrt(share / (share + (1.0 - share) * along_direction())), sign};
  }
  [[nodiscard]] double largest_eigenvalue() const { return std::max(1.0, along_direction()); }
  [[nodiscard]] double trace() const { return Dim + sign * direction.squaredNorm(); }
};

}  // namespace suffuse

#pragma once

/// A conductivity that varies at random from place to place: a stationary lognormal field. It is a
/// function of the place alone, so that every mesh sees the same field.

#include <array>
#include <vector>

namespace suffuse {

/// ln k is Gaussian with the correlation exp(-(r/l)^2), l along and across bedding.
struct FieldModel {
  double variation = 0.0;  ///< standard deviation of k over its mean; 0: k does not vary
  double along = 0.0;      ///< l along bedding, m
  double across = 0.0;     ///< l across bedding, m
  int seed = 1;

  [[nodiscard]] bool varies() const { return variation > 0.0; }
};

/// One draw of a field, as a sum of waves whose numbers and phases are random (Shinozuka and
/// Deodatis 1991, doi 10.1115/1.3119501).
class LognormalField {
 public:
  /// \param bedding  angle of the bedding from the x-axis, degrees
  LognormalField(const FieldModel& model, double bedding);

  /// k over its mean at a place, m; `z` is the height in a plane section, `y` then 0.
  [[nodiscard]] double at(double x, double y, double z) const;
  /// The same ratio at a place of two (x, height) or three coordinates.
  template <class Position>
  [[nodiscard]] double at(const Position& x) const {
    return x.size() == 2 ? at(x[0], 0.0, x[1]) : at(x[0], x[1], x[2]);
  }

 private:
  struct Wave {
    std::array<double, 3> number;  ///< along bedding in the x-z plane, along y, across, 1/m
    double phase;
  };
  std::vector<Wave> waves_;
  double deviation_;  ///< of ln k
  double cosine_;     ///< of the angle of the bedding
  double sine_;
};

}  // namespace suffuse

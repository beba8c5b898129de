#pragma once

/// A homogeneous soil element as in a laboratory test: a strain or a stress is prescribed for each
/// component, while fines are lost. The response does not depend on time.

#include <Eigen/Core>
#include <array>

#include "physics/skeleton/skeleton_response.hpp"

namespace suffuse {

/// Components xx, yy, zz and xy of a symmetric tensor; tension and stretching are positive. The xy
/// component of a strain is half of gamma_xy.
using PlaneComponents = Eigen::Vector4d;

struct SoilElementState {
  PlaneComponents strain = PlaneComponents::Zero();  ///< logarithmic, from the start
  PlaneComponents stress = PlaneComponents::Zero();  ///< effective stress sigma' (Cauchy), Pa
  SkeletonState skeleton;
  double plastic_strain = 0.0;  ///< equivalent, sum of its increments
  double fines_left = 1.0;      ///< share of the erodible fines

  /// p' = -(xx + yy + zz)/3, Pa: positive in compression.
  [[nodiscard]] double mean_stress() const { return -stress.head<3>().sum() / 3.0; }
  /// q = sqrt(3 J_2), Pa.
  [[nodiscard]] double deviator_stress() const;
  /// Logarithm of the volume ratio to the start.
  [[nodiscard]] double volumetric_strain() const { return strain.head<3>().sum(); }
};

/// Target of a step: a strain or a stress per component.
struct SoilElementTarget {
  PlaneComponents value = PlaneComponents::Zero();
  std::array<bool, 4> is_stress{};
  double fines_left = 1.0;
};

class SoilElement {
 public:
  /// Creates the element at the start, with zero strain.
  /// \param model   has a law; must outlive the element
  /// \param stress  sigma', Pa
  SoilElement(const SkeletonModel& model, const PlaneComponents& stress, double fines_left);

  [[nodiscard]] const SoilElementState& state() const { return state_; }
  /// Whether the stress is admissible for the law. Always true after `advance`.
  [[nodiscard]] bool is_admissible() const;

  /// Takes each component and the fines linearly to the target, in as many steps as Newton's method
  /// needs.
  /// \return share of the way that was reached: less than 1 if the soil cannot carry the stresses;
  ///         the state is then the last one that it can carry.
  double advance(const SoilElementTarget& target);

 private:
  bool try_step(const SoilElementTarget& target);

  const SkeletonModel& model_;
  SoilElementState state_;
};

}  // namespace suffuse

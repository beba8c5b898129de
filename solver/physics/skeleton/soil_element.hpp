#pragma once

/// One point of soil under control, as in a laboratory's cell: each component follows a strain or a
/// stress, while fines are lost. Nothing varies from place to place, and time has no part in it.

#include <Eigen/Core>
#include <array>

#include "physics/skeleton/skeleton_response.hpp"

namespace suffuse {

/// Components xx, yy, zz and xy of a symmetric tensor; tension and stretching are positive. The xy
/// of a strain is half the change of the right angle.
using PlaneComponents = Eigen::Vector4d;

struct SoilElementState {
  PlaneComponents strain = PlaneComponents::Zero();  ///< logarithmic, since the start
  PlaneComponents stress =
      PlaneComponents::Zero();  ///< effective stress sigma', of today's area, Pa
  SkeletonState skeleton;
  double plastic_strain = 0.0;  ///< equivalent, sum of its increments
  double fines_left = 1.0;      ///< share of the erodible fines

  /// p' = -(xx + yy + zz)/3, Pa: positive in compression.
  [[nodiscard]] double mean_stress() const { return -stress.head<3>().sum() / 3.0; }
  /// q = sqrt(3 J_2), Pa.
  [[nodiscard]] double deviator_stress() const;
  /// Logarithm of the volume over that at the start.
  [[nodiscard]] double volumetric_strain() const { return strain.head<3>().sum(); }
};

/// Where a step leads: per component a strain or a stress.
struct SoilElementTarget {
  PlaneComponents value = PlaneComponents::Zero();
  std::array<bool, 4> is_stress{};
  double fines_left = 1.0;
};

class SoilElement {
 public:
  /// At the start, where strains are 0 and volumes count from.
  /// \param model   has a law; must outlive the element
  /// \param stress  sigma', Pa
  SoilElement(const SkeletonModel& model, const PlaneComponents& stress, double fines_left);

  [[nodiscard]] const SoilElementState& state() const { return state_; }
  /// The law can carry the stress of the state. Always true after `advance`.
  [[nodiscard]] bool is_admissible() const;

  /// Takes each component, and the fines, straight from where it is to the target: in one step, or
  /// in as many as Newton's method needs.
  /// \return the share of the way that was found, 1 but where the soil cannot carry the stresses:
  ///         the state is then the last one that it carries.
  double advance(const SoilElementTarget& target);

 private:
  bool try_step(const SoilElementTarget& target);

  const SkeletonModel& model_;
  SoilElementState state_;
};

}  // namespace suffuse

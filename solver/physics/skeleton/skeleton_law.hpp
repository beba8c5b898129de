#pragma once

/// Laws of the skeleton: effective stress as a function of the deformation. Each law is one file of
/// this folder; docs/develop/contributing.md says how to add one. All are isotropic, so a law works
/// with principal values; `skeleton_response.hpp` forms the tensors.

#include <Eigen/Core>
#include <span>
#include <string_view>

#include "physics/skeleton/skeleton_model.hpp"

namespace suffuse {

/// The response to three principal strains, in their order. Tension is positive.
struct PrincipalResponse {
  Eigen::Vector3d stress = Eigen::Vector3d::Zero();          ///< Kirchhoff stress tau_i, Pa
  Eigen::Vector3d elastic_strain = Eigen::Vector3d::Zero();  ///< logarithmic, after the increment
  /// Equivalent plastic strain of the increment, sqrt(2/3) |trial - elastic_strain|; 0: elastic.
  double plastic_strain = 0.0;
  double internal_change = 0.0;                       ///< change of the internal variable
  Eigen::Matrix3d tangent = Eigen::Matrix3d::Zero();  ///< d stress_i / d trial_j, Pa
  /// (tau_i - tau_j) / (trial_i - trial_j), entry k for the two indices other than k, Pa; its limit
  /// if the two strains are equal. 2 G in the elastic range.
  Eigen::Vector3d shear_secant = Eigen::Vector3d::Zero();
};

/// A law of the skeleton.
struct SkeletonLaw {
  /// Whether the law has a strength, which a factor of safety can divide.
  [[nodiscard]] bool has_strength() const;
  /// Whether its soil can yield: elastic laws have two parameters.
  [[nodiscard]] bool yields() const { return parameters.size() > 2; }

  std::string_view word;         ///< value of `law` in a scene
  std::string_view description;  ///< for the scene reference
  std::span<const SkeletonParameter> parameters;
  /// The response to trial strains in any order: the elastic logarithmic strains before the
  /// increment plus the increment. Finite strains must give finite values. `internal`: the internal
  /// variable before the increment.
  PrincipalResponse (*respond)(const SkeletonParameters& parameters, const Eigen::Vector3d& trial,
                               double internal);
  /// Name of the internal variable in snapshots, 0 at the start. Empty: the law has none.
  std::string_view internal = {};
};

/// All laws, in the order of physics/CMakeLists.txt and the scene reference.
std::span<const SkeletonLaw* const> skeleton_laws();
/// The law with the name `word`. Throws std::invalid_argument if there is none.
const SkeletonLaw* skeleton_law(std::string_view word);

}  // namespace suffuse

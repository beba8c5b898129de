#pragma once

/// Laws of the skeleton: the effective stress that follows from the deformation. Each law is one
/// file of this folder; docs/contributing.md says how to add one. All are isotropic, so a law sees
/// principal values alone; `skeleton_response.hpp` makes tensors of them.

#include <Eigen/Core>
#include <span>
#include <string_view>

#include "physics/skeleton/skeleton_model.hpp"

namespace suffuse {

/// What a law answers to three principal strains, in their order. Tension is positive.
struct PrincipalResponse {
  Eigen::Vector3d stress = Eigen::Vector3d::Zero();          ///< Kirchhoff stress tau_i, Pa
  Eigen::Vector3d elastic_strain = Eigen::Vector3d::Zero();  ///< logarithmic, that is left
  /// Equivalent plastic strain of the increment, sqrt(2/3) |trial - elastic_strain|; 0: elastic.
  double plastic_strain = 0.0;
  double internal_change = 0.0;                       ///< of the law's internal variable
  Eigen::Matrix3d tangent = Eigen::Matrix3d::Zero();  ///< d stress_i / d trial_j, Pa
  /// (tau_i - tau_j) / (trial_i - trial_j), entry k for the two others than k, Pa; its limit where
  /// the two strains are equal. 2 G where the law is elastic.
  Eigen::Vector3d shear_secant = Eigen::Vector3d::Zero();
};

/// A law, as its file declares it.
struct SkeletonLaw {
  /// Whether it has a strength, which can be divided by a factor of safety.
  [[nodiscard]] bool yields() const;

  std::string_view word;         ///< what `law` is in a scene
  std::string_view description;  ///< for the scene reference
  std::span<const SkeletonParameter> parameters;
  /// The response to the trial strains: the elastic logarithmic strains before the increment, with
  /// all of the increment added. They come in any order. The same formula holds for any trial
  /// strain: no NaN for finite strains. `internal`: the internal variable before the increment.
  PrincipalResponse (*respond)(const SkeletonParameters& parameters, const Eigen::Vector3d& trial,
                               double internal);
  /// Name of the law's internal variable in snapshots; it is 0 at the start. Empty: it has none.
  std::string_view internal = {};
};

/// Every law there is, in the order of the scene reference: the order in physics/CMakeLists.txt.
std::span<const SkeletonLaw* const> skeleton_laws();
/// The law that a scene calls `word`. Throws std::invalid_argument where there is none.
const SkeletonLaw* skeleton_law(std::string_view word);

}  // namespace suffuse

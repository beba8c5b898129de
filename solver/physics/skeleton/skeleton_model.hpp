#pragma once

/// What a scene says about the skeleton of a soil: its law, and numbers that may change as fines
/// leave. The solver asks for the numbers at each point, `SkeletonModel::at`.

#include <string_view>
#include <utility>
#include <vector>

namespace suffuse {

struct SkeletonLaw;

/// A number that goes with the share of the erodible fines that is left, 1 at the start: linear
/// between pairs, constant beyond the first and the last.
struct FinesFunction {
  /// One value at all shares. Implicit: a plain number is the usual value.
  FinesFunction(double value = 0.0) : pairs{{1.0, value}} {}  // NOLINT(google-explicit-constructor)
  /// \param all  share and value, at least one pair; shares strictly ascend, or strictly descend
  explicit FinesFunction(std::vector<std::pair<double, double>> all);

  [[nodiscard]] double value(double fines_left) const;
  [[nodiscard]] double smallest() const;

  friend bool operator==(const FinesFunction&, const FinesFunction&) = default;

  std::vector<std::pair<double, double>> pairs;  ///< shares strictly ascend
};

/// The numbers of a law at one point and time.
struct SkeletonParameters {
  double young = 0.0;             ///< E, Pa
  double poisson = 0.0;           ///< nu
  double friction = 0.0;          ///< phi, rad
  double cohesion = 0.0;          ///< c, Pa
  double dilation = 0.0;          ///< psi, rad
  double compression = 0.0;       ///< Lambda
  double preconsolidation = 0.0;  ///< p_c0, Pa

  /// G, Pa
  [[nodiscard]] double shear_modulus() const { return young / (2.0 * (1.0 + poisson)); }
  /// Lame's first parameter, Pa
  [[nodiscard]] double lame() const {
    return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
  }
  /// Stress over strain without lateral strain, Pa
  [[nodiscard]] double oedometer_modulus() const { return lame() + 2.0 * shear_modulus(); }
};

/// One soil's law with its numbers, as the scene gives them: angles in degrees.
struct SkeletonModel {
  const SkeletonLaw* law = nullptr;     ///< null: rigid
  FinesFunction young = {};             ///< E, Pa
  FinesFunction poisson = {};           ///< nu
  FinesFunction friction = {};          ///< phi, degrees
  FinesFunction cohesion = {};          ///< c, Pa
  FinesFunction dilation = {};          ///< psi, degrees
  FinesFunction compression = {};       ///< Lambda
  FinesFunction preconsolidation = {};  ///< p_c0, Pa

  [[nodiscard]] bool moves() const { return law != nullptr; }
  /// The numbers where this share of the erodible fines is left.
  [[nodiscard]] SkeletonParameters at(double fines_left) const;
};

/// A number that a law asks the scene for, under `[soil.NAME.skeleton]`.
struct SkeletonParameter {
  std::string_view key;
  std::string_view symbol;
  std::string_view unit;
  std::string_view sentence;  ///< for the scene reference
  double lower;
  bool lower_allowed;  ///< the value may be `lower` itself
  double upper;        ///< the value is below this
  bool follows_fines;  ///< pairs of share and value are accepted too
  bool required;       ///< otherwise 0
  FinesFunction SkeletonModel::*value = nullptr;
};

}  // namespace suffuse

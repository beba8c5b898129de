#pragma once

/// The skeleton of a soil as the scene gives it: its law, and parameters that may depend on the
/// remaining fines. `SkeletonModel::at` gives the parameters at a point.

#include <string_view>
#include <utility>
#include <vector>

namespace suffuse {

struct SkeletonLaw;

/// A function of the remaining share of the erodible fines, 1 at the start: linear between pairs,
/// constant beyond the first and the last.
struct FinesFunction {
  /// A constant. Implicit, because most parameters are plain numbers.
  FinesFunction(double value = 0.0) : pairs{{1.0, value}} {}  // NOLINT(google-explicit-constructor)
  /// \param all  share and value, at least one pair; shares strictly ascend, or strictly descend
  explicit FinesFunction(std::vector<std::pair<double, double>> all);

  [[nodiscard]] double value(double fines_left) const;
  [[nodiscard]] double smallest() const;

  friend bool operator==(const FinesFunction&, const FinesFunction&) = default;

  std::vector<std::pair<double, double>> pairs;  ///< shares strictly ascend
};

/// The parameters of a law at one point and time.
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
  /// Oedometer modulus: stress over strain without lateral strain, Pa
  [[nodiscard]] double oedometer_modulus() const { return lame() + 2.0 * shear_modulus(); }
};

/// The law of a soil and its parameters as in the scene: angles in degrees.
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
  /// The parameters for this remaining share of the erodible fines.
  [[nodiscard]] SkeletonParameters at(double fines_left) const;
};

/// A parameter of a law, read from `[soil.NAME.skeleton]`.
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

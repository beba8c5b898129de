/// Modified Cam clay (Roscoe and Burland 1968) with Hencky's elasticity. It yields at
/// q^2/M^2 = p (p_c - p) with associated flow; p_c = p_c0 exp(v / Lambda), v being plastic
/// compaction. The return is implicit (Borja and Tamagnini, Comput. Methods Appl. Mech. Eng. 155
/// (1998) 73).

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "physics/skeleton/elasticity.hpp"

namespace suffuse::skeleton {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int most_iterations = 200;
/// Soil loses all strength if p_c falls below this share of p_c before the increment plus the trial
/// tension.
constexpr double next_to_nothing = 1e-8;

/// Return mapping of a trial stress: pressure p, positive in compression, and shear stress q.
struct Clay {
  Clay(const SkeletonParameters& s, double trial_pressure, double trial_shear, double compacted)
      : bulk(s.lame() + 2.0 / 3.0 * s.shear_modulus()),
        shear(s.shear_modulus()),
        slope(6.0 * std::sin(s.friction) / (3.0 - std::sin(s.friction))),
        compression(s.compression),
        preconsolidation(s.preconsolidation * std::exp(compacted / compression)),
        p_trial(trial_pressure),
        q_trial(trial_shear) {}

  /// p_c after plastic compaction v in the increment, Pa.
  [[nodiscard]] double limit(double v) const {
    return preconsolidation * std::exp(v / compression);
  }
  [[nodiscard]] double pressure(double v) const { return p_trial - bulk * v; }
  /// Whether p_c is next to nothing once loosening has removed the trial tension.
  [[nodiscard]] bool bears_nothing() const {
    return p_trial < 0.0 && limit(p_trial / bulk) < next_to_nothing * (preconsolidation - p_trial);
  }
  /// The compaction for the multiplier g, 1/Pa: the only solution of v = g (2 p - p_c).
  [[nodiscard]] double compaction(double g) const {
    // Two upper bounds of v: for p_c = 0, and for p_c grown by 2 p_trial.
    double v = 2.0 * g * p_trial / (1.0 + 2.0 * bulk * g);
    if (v > 0.0) v = std::min(v, compression * std::log1p(2.0 * p_trial / preconsolidation));
    for (int i = 0; i < most_iterations; ++i) {
      const double error = v - g * (2.0 * pressure(v) - limit(v));
      const double change = error / (1.0 + g * (2.0 * bulk + limit(v) / compression));
      v -= change;
      if (std::abs(change) <= 1e-15 * std::abs(v)) break;
    }
    return v;
  }
  /// q / q_trial, from q = q_trial - 3 G g 2 q/M^2.
  [[nodiscard]] double shear_left(double g) const {
    return 1.0 / (1.0 + 6.0 * shear * g / (slope * slope));
  }
  /// q^2/M^2 + p (p - p_c), Pa^2
  [[nodiscard]] double excess(double g) const {
    const double q = q_trial * shear_left(g) / slope;
    const double v = g > 0.0 ? compaction(g) : 0.0;
    return q * q + pressure(v) * (pressure(v) - limit(v));
  }

  double bulk;              ///< K, Pa
  double shear;             ///< G, Pa
  double slope;             ///< M
  double compression;       ///< Lambda
  double preconsolidation;  ///< p_c before the increment, Pa
  double p_trial;           ///< Pa
  double q_trial;           ///< Pa
};

/// The multiplier that returns the stress to the yield surface, by bisection and secants
/// (Illinois). The excess is positive at g = 0 and tends to -p^2 at the critical state.
double multiplier(const Clay& clay) {
  double low = 0.0;
  double high = 1.0 / clay.bulk;
  double f_low = clay.excess(low);
  double f_high = clay.excess(high);
  while (f_high > 0.0 && high < 1e100) {
    low = high;
    f_low = f_high;
    high *= 2.0;
    f_high = clay.excess(high);
  }
  for (int i = 0; i < most_iterations; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    double g = (low * f_high - high * f_low) / (f_high - f_low);
    if (i % 3 == 2 || !(g > low && g < high)) g = middle;
    const double f = clay.excess(g);
    if (f == 0.0) return g;
    if (f > 0.0) {
      low = g;
      f_low = f;
      f_high *= 0.5;
    } else {
      high = g;
      f_high = f;
      f_low *= 0.5;
    }
  }
  return high;
}

PrincipalResponse respond(const SkeletonParameters& p, const Vector3d& trial, double compaction) {
  PrincipalResponse response = elastic_response(p, trial);
  const double mean = trial.mean();
  const Vector3d deviator = trial.array() - mean;
  const double length = deviator.norm();
  const double q_of_length = std::sqrt(6.0) * p.shear_modulus();  // q of a deviator of 1
  const double bulk = p.lame() + 2.0 / 3.0 * p.shear_modulus();
  const Clay clay(p, -3.0 * bulk * mean, q_of_length * length, compaction);
  // A stress on the surface within round-off does not yield.
  const double size = clay.preconsolidation + std::abs(clay.p_trial);
  if (clay.excess(0.0) <= (1e-12 * size + 1e-14 * p.young) * size) return response;
  if (clay.bears_nothing()) {
    PrincipalResponse nothing;
    nothing.plastic_strain = std::sqrt(2.0 / 3.0) * trial.norm();
    nothing.internal_change = p.compression * std::log(next_to_nothing);
    return nothing;
  }

  const double g = multiplier(clay);
  const double v = clay.compaction(g);
  const double p_c = clay.limit(v);
  const double pressure = clay.pressure(v);
  const double left = clay.shear_left(g);
  response.internal_change = v;
  response.elastic_strain = mean + v / 3.0 + left * deviator.array();
  response.stress = -pressure + 2.0 * clay.shear * left * deviator.array();
  response.plastic_strain = std::sqrt(2.0 / 3.0) * (trial - response.elastic_strain).norm();
  response.shear_secant.setConstant(2.0 * clay.shear * left);

  // Derivatives of g and v with respect to the trial's p and q, from their two equations.
  const double of_shear = 6.0 * clay.shear / (clay.slope * clay.slope);
  const double q = clay.q_trial * left;
  const double hardening = p_c / clay.compression;  // d p_c / d v
  Matrix2d equations;  // rows: v - g (2 p - p_c), excess; columns: g, v
  equations << -(2.0 * pressure - p_c), 1.0 + g * (2.0 * clay.bulk + hardening),
      -2.0 * q * q * of_shear * left / (clay.slope * clay.slope),
      -clay.bulk * (2.0 * pressure - p_c) - pressure * hardening;
  Matrix2d by_trial;  // columns: p, q
  by_trial << -2.0 * g, 0.0, 2.0 * pressure - p_c, 2.0 * q * left / (clay.slope * clay.slope);
  const Matrix2d change = -equations.inverse() * by_trial;  // of g and v, by p and q
  const Vector2d pressure_by = Vector2d(1.0, 0.0) - clay.bulk * change.row(1).transpose();
  const Vector2d left_by = -of_shear * left * left * change.row(0).transpose();
  const Vector3d direction = length > 0.0 ? Vector3d(deviator / length) : Vector3d::Zero();
  const Vector3d p_by_strain = Vector3d::Constant(-clay.bulk);
  const Vector3d q_by_strain = q_of_length * direction;
  const auto by_strain = [&](const Vector2d& by) -> Vector3d {
    return by[0] * p_by_strain + by[1] * q_by_strain;
  };
  response.tangent.setConstant(-2.0 / 3.0 * clay.shear * left);
  response.tangent.diagonal().array() += 2.0 * clay.shear * left;
  response.tangent.rowwise() -= by_strain(pressure_by).transpose();
  response.tangent += 2.0 * clay.shear * deviator * by_strain(left_by).transpose();
  return response;
}

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr SkeletonParameter critical_friction{
    .key = "critical_friction",
    .symbol = "phi_cs",
    .unit = "degrees",
    .sentence = "Angle of friction of the critical state, M = 6 sin phi_cs/(3 - sin phi_cs).",
    .lower = 0.0,
    .lower_allowed = false,
    .upper = 90.0,
    .follows_fines = true,
    .required = true,
    .value = &SkeletonModel::friction};
constexpr SkeletonParameter compression{
    .key = "compression",
    .symbol = "Lambda",
    .unit = "",
    .sentence =
        "Plastic compaction per logarithm of the preconsolidation pressure, (lambda - "
        "kappa)/(1 + e).",
    .lower = 0.0,
    .lower_allowed = false,
    .upper = infinity,
    .follows_fines = true,
    .required = true,
    .value = &SkeletonModel::compression};
constexpr SkeletonParameter preconsolidation{
    .key = "preconsolidation",
    .symbol = "p_c0",
    .unit = "Pa",
    .sentence = "Largest mean effective stress that the soil has borne before the start.",
    .lower = 0.0,
    .lower_allowed = false,
    .upper = infinity,
    .follows_fines = true,
    .required = true,
    .value = &SkeletonModel::preconsolidation};
constexpr std::array parameters{young, poisson, critical_friction, compression, preconsolidation};

}  // namespace

extern const SkeletonLaw cam_clay{
    .word = "cam-clay",
    .description =
        "modified Cam clay: yields on an ellipse through p' = 0 and the preconsolidation "
        "pressure, hardens as it compacts and softens as it dilates",
    .parameters = parameters,
    .respond = respond,
    .internal = "plastic_compaction"};

}  // namespace suffuse::skeleton

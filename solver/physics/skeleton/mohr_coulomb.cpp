/// Perfect plasticity with Mohr-Coulomb's yield surface, its edges and its apex. The return mapping
/// is in principal stresses (de Souza Neto, Peric and Owen, Computational Methods for Plasticity
/// (2008), 8.2; Clausen, Damkilde and Andersen, Comput. Struct. 85 (2007) 1795).

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "physics/skeleton/elasticity.hpp"

namespace suffuse::skeleton {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Place to which the stress returns: to one plane, to the edge of two planes, or to the apex.
enum class Place { plane, edge_of_largest, edge_of_smallest, apex };

/// Parameters of the law, for strains and stresses in descending order.
struct Limit {
  /// Normal of the yield plane of two stresses: (1 + s) tau_i - (1 - s) tau_j = strength,
  /// s = sin phi. With s = sin psi it is the direction of plastic flow.
  [[nodiscard]] static Vector3d normal(int i, int j, double s) {
    Vector3d result = Vector3d::Zero();
    result[i] = 1.0 + s;
    result[j] = s - 1.0;
    return result;
  }

  double sin_friction;
  double sin_dilation;
  double strength;  ///< 2 c cos phi, Pa
  Matrix3d elastic;
};

/// Returns the trial stress along the flow directions of one or two planes.
template <int Planes>
void return_to(const Limit& limit, const std::array<std::array<int, 2>, Planes>& pairs,
               PrincipalResponse& response) {
  Eigen::Matrix<double, 3, Planes> normals;
  Eigen::Matrix<double, 3, Planes> flows;
  for (int k = 0; k < Planes; ++k) {
    normals.col(k) = Limit::normal(pairs[k][0], pairs[k][1], limit.sin_friction);
    flows.col(k) = Limit::normal(pairs[k][0], pairs[k][1], limit.sin_dilation);
  }
  const Eigen::Matrix<double, 3, Planes> relaxed = limit.elastic * flows;
  const Eigen::Matrix<double, Planes, Planes> inverse = (normals.transpose() * relaxed).inverse();
  const Eigen::Matrix<double, Planes, 1> excess =
      (normals.transpose() * response.stress).array() - limit.strength;
  const Eigen::Matrix<double, Planes, 1> multipliers = inverse * excess;
  response.stress -= relaxed * multipliers;
  response.elastic_strain -= flows * multipliers;
  response.tangent -= relaxed * inverse * normals.transpose() * limit.elastic;
}

void return_to_apex(const SkeletonParameters& p, PrincipalResponse& response) {
  response.stress.setConstant(p.cohesion / std::tan(p.friction));
  response.elastic_strain = elastic_strain(p, response.stress);
  response.tangent.setZero();
}

/// Returns a trial stress beyond the limit; finds the place and the response there.
Place return_stress(const SkeletonParameters& p, const Limit& limit, PrincipalResponse& response) {
  const PrincipalResponse trial = response;
  return_to<1>(limit, {{{0, 2}}}, response);
  const double tolerance = 1e-14 * trial.stress.cwiseAbs().maxCoeff();
  Vector3d stress = response.stress;
  if (stress[0] >= stress[1] - tolerance && stress[1] >= stress[2] - tolerance) return Place::plane;

  // On this plane through the hydrostatic axis the return meets both edges at once, the apex.
  const double s = limit.sin_dilation;
  const bool largest = (1.0 - s) * stress[0] - 2.0 * stress[1] + (1.0 + s) * stress[2] < 0.0;
  response = trial;
  if (largest) {
    return_to<2>(limit, {{{0, 2}, {1, 2}}}, response);
  } else {
    return_to<2>(limit, {{{0, 2}, {0, 1}}}, response);
  }
  stress = response.stress;
  if (limit.sin_friction == 0.0 || stress[0] - stress[2] >= 0.0) {
    return largest ? Place::edge_of_largest : Place::edge_of_smallest;
  }
  response = trial;
  return_to_apex(p, response);
  return Place::apex;
}

/// (tau_i - tau_j) / (trial_i - trial_j) for i before j in descending order.
double secant(const PrincipalResponse& response, const Vector3d& trial, double double_shear, int i,
              int j) {
  const double difference = trial[i] - trial[j];
  if (difference <= 0.0) return double_shear;  // equal trial stresses stay equal
  return std::clamp((response.stress[i] - response.stress[j]) / difference, 0.0, double_shear);
}

/// Whether these stresses are below the limit by bounds of sine and cosine. Most points are, and
/// the functions themselves would take a sixth of their time.
bool is_far_from_limit(const SkeletonParameters& p, double largest, double smallest) {
  const double square = p.friction * p.friction;
  const double sum = largest + smallest;
  const double sine = p.friction * (sum < 0.0 ? 1.0 - square / 6.0 : 1.0);
  return largest - smallest + sum * sine <= 2.0 * p.cohesion * (1.0 - 0.5 * square);
}

PrincipalResponse respond(const SkeletonParameters& p, const Vector3d& trial, double /*internal*/) {
  PrincipalResponse response = elastic_response(p, trial);
  const double largest = response.stress.maxCoeff();
  const double smallest = response.stress.minCoeff();
  if (is_far_from_limit(p, largest, smallest)) return response;
  const double sin_friction = std::sin(p.friction);
  const double strength = 2.0 * p.cohesion * std::cos(p.friction);
  const double excess = largest - smallest + (largest + smallest) * sin_friction;
  // A stress on the limit within round-off does not yield.
  const double round_off =
      1e-12 * (std::abs(largest) + std::abs(smallest) + strength) + 1e-14 * p.young;
  if (excess <= strength + round_off) return response;
  const Limit limit{sin_friction, std::sin(p.dilation), strength, response.tangent};

  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, [&](int a, int b) { return trial[a] > trial[b]; });
  PrincipalResponse sorted = elastic_response(p, trial(order));
  const Place place = return_stress(p, limit, sorted);
  const double double_shear = 2.0 * p.shear_modulus();
  const Vector3d ordered = trial(order);
  Vector3d secants = Vector3d::Zero();
  if (place != Place::apex) {
    secants[1] = secant(sorted, ordered, double_shear, 0, 2);
    if (place != Place::edge_of_largest) secants[2] = secant(sorted, ordered, double_shear, 0, 1);
    if (place != Place::edge_of_smallest) secants[0] = secant(sorted, ordered, double_shear, 1, 2);
  }
  for (int a = 0; a < 3; ++a) {
    response.stress[order[a]] = sorted.stress[a];
    response.elastic_strain[order[a]] = sorted.elastic_strain[a];
    response.shear_secant[order[a]] = secants[a];
    for (int b = 0; b < 3; ++b) response.tangent(order[a], order[b]) = sorted.tangent(a, b);
  }
  response.plastic_strain = std::sqrt(2.0 / 3.0) * (trial - response.elastic_strain).norm();
  return response;
}

constexpr std::array parameters{young, poisson, friction, cohesion, dilation};

}  // namespace

extern const SkeletonLaw mohr_coulomb{
    .word = "mohr-coulomb",
    .description =
        "yields where the shear stress of a plane is c + sigma' tan phi, dilates by psi "
        "then; without cohesion it bears no tension",
    .parameters = parameters,
    .respond = respond};

}  // namespace suffuse::skeleton

#pragma once

/// Bodies of dry soil with inertia, for tests without files and flow.

#include <algorithm>
#include <numbers>

#include "dry_motion.hpp"
#include "motion/soil_inertia.hpp"
#include "solver/solid_model.hpp"

namespace suffuse::model {

/// Friction that grows with the rate of shear.
struct RateFriction {
  double slow = 31.0;       ///< angle at rest, degrees
  double fast = 31.0;       ///< angle at large rates, degrees
  double grain_size = 0.0;  ///< m; 0: friction does not grow
};

/// Soil on crossed triangles with four points each.
struct InertialModel : PlaneModel {
  InertialModel(Mesh<2> mesh_in, const SkeletonModel& soil, double density, const Vector<2>& g,
                const std::function<bool(const Vector<2>&)>& holds)
      : PlaneModel(std::move(mesh_in), 4, soil, holds), gravity(g) {
    for (const double v : points.volume) mass.push_back(density * v);
  }

  /// To be called after all supports are set.
  void start_motion(const InertialLimits& inertial = {}) {
    supports = std::make_unique<Supports<2>>(grid, face_support);
    motion = std::make_unique<InertialMotion<2>>(grid, *supports, points.size(), threads, inertial);
  }

  [[nodiscard]] NodeVectors<2> loads() const {
    std::vector<Vector<2>> force;
    for (const double m : mass) force.emplace_back(m * gravity);
    NodalLoads<2> result(grid);
    add_point_forces(grid, points, force, result);
    return result.forces();
  }
  /// Sets the friction to that at the rate of the last step (Jop, Forterre and Pouliquen, Nature
  /// 441 (2006) 727): mu_s + (mu_2 - mu_s)/(1 + I_0/I) with I = rate d/sqrt(p/rho), I_0 = 0.279.
  void follow_rate(const RateFriction& law, double grain_density) {
    constexpr double inertial_number_of_mean = 0.279;
    constexpr double least_pressure = 1.0;  // Pa
    constexpr double degree = std::numbers::pi / 180.0;
    const double slow = std::tan(law.slow * degree);
    const double fast = std::tan(law.fast * degree);
    const std::vector<double>& rate = motion->shear_rate();
    for (std::size_t p = 0; p < rate.size(); ++p) {
      const double pressure = std::max(-stress(static_cast<int>(p)).trace() / 3.0, least_pressure);
      const double number = rate[p] * law.grain_size / std::sqrt(pressure / grain_density);
      const double share = number / (number + inertial_number_of_mean);
      skeleton[p].parameters.friction = std::atan((1.0 - share) * slow + share * fast);
    }
  }
  /// Makes one step of at most `longest` seconds.
  InertialStep move(double longest) {
    const InertialStep step = motion->step(points, skeleton, mass, loads(), longest);
    time += step.duration;
    sort();
    return step;
  }
  [[nodiscard]] double weight() const {
    double sum = 0.0;
    for (const double m : mass) sum += m;
    return sum * gravity.norm();
  }
  /// \param height  of the soil, m
  [[nodiscard]] SoilExtent extent(double height) const {
    return {weight() / gravity.norm(), weight(), height};
  }
  [[nodiscard]] double energy() const { return motion->velocities().kinetic_energy(mass); }

  Vector<2> gravity;
  std::vector<double> mass;  ///< per point, kg
  std::unique_ptr<Supports<2>> supports;
  std::unique_ptr<InertialMotion<2>> motion;
  double time = 0.0;
};

inline SkeletonModel frictional_soil(double young, double friction, double cohesion = 0.0) {
  SkeletonModel soil = elastic_soil(young, 0.3);
  soil.law = skeleton_law("mohr-coulomb");
  soil.friction = friction;
  soil.cohesion = cohesion;
  return soil;
}

/// A column of dry sand of width 1 and height `aspect`, whose gate on the right is removed; a
/// symmetry plane lies at its left.
struct Collapse {
  double aspect = 1.0;
  int cells = 8;  ///< per width of the column
  double reach = 3.5;
  double longest = 0.01;  ///< s
  double end = 5.0;       ///< s
  int threads = 1;
  RateFriction friction = {};
};

struct CollapseResult {
  double runout = 0.0;  ///< of the farthest point except 0.5 % of them, relative to the width
  double height = 0.0;
  double time = 0.0;  ///< when the soil comes to rest, or `end`, s
  bool rests = false;
  int steps = 0;
  double iterations = 0.0;  ///< per step
  int tries = 0;
  double volume = 0.0;  ///< relative to the initial one
  std::vector<Vector<2>> places;
  std::vector<double> volumes;  ///< per point

  /// Depth of the soil in a strip around x, of this width.
  [[nodiscard]] double depth(double x, double strip) const {
    double sum = 0.0;
    for (std::size_t p = 0; p < places.size(); ++p) {
      if (std::abs(places[p][0] - x) < 0.5 * strip) sum += volumes[p];
    }
    return sum / strip;
  }
  /// How far soil of this depth has run out: strips are an eighth of the column wide.
  [[nodiscard]] double runout_of_depth(double least) const {
    constexpr double strip = 0.125;
    constexpr double step = 0.125 * strip;
    double x = 0.5 * strip;
    while (depth(x + step, strip) > least) x += step;
    const double here = depth(x, strip);
    return x + step * (here - least) / (here - depth(x + step, strip)) - 1.0;
  }
};

inline CollapseResult collapse(const Collapse& c) {
  const double h = 1.0 / c.cells;
  const double tall = c.aspect + 2.0 * h;
  const int columns = static_cast<int>(std::lround(c.reach * c.cells));
  const int rows = static_cast<int>(std::lround(tall * c.cells));
  InertialModel m(crossed_mesh(columns, rows, columns * h, rows * h),
                  frictional_soil(1e6, c.friction.slow), 1600.0, {0.0, -9.81},
                  [&](const Vector<2>& x) { return x[0] < 1.0 && x[1] < c.aspect; });
  m.threads = c.threads;
  m.support("left", Support::normal);
  m.support("right", Support::normal);
  m.support("bottom", Support::both);
  m.start_motion();
  CollapseResult result;
  const double before = m.soil_volume();
  while (m.time < c.end && !result.rests) {
    if (c.friction.grain_size > 0.0) m.follow_rate(c.friction, 2650.0);
    const InertialStep step = m.move(std::min(c.longest, c.end - m.time));
    ++result.steps;
    result.iterations += step.iterations;
    result.tries += step.tries;
    // At the very start nothing has moved yet, which is no rest.
    result.rests =
        m.time > 0.5 && SoilKinetics{m.energy(), step.inertia_share, m.extent(c.aspect)}.is_rest();
  }
  result.iterations /= result.steps;
  result.time = m.time;
  result.volume = m.soil_volume() / before;
  result.places = m.points.position;
  result.volumes = m.points.volume;
  std::vector<double> x;
  for (const Vector<2>& place : m.points.position) {
    x.push_back(place[0]);
    result.height = std::max(result.height, place[1]);
  }
  std::ranges::sort(x);
  result.runout = x[static_cast<std::size_t>(0.995 * static_cast<double>(x.size()))] - 1.0;
  return result;
}

}  // namespace suffuse::model

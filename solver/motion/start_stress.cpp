#include "motion/start_stress.hpp"

#include <algorithm>

#include "grid/parallel.hpp"

namespace suffuse {
namespace {

/// Each pass undoes the displacement of the one before; its error is its strain squared.
constexpr int max_passes = 60;
/// Number of parts of the loads if soil yields too much under all at once.
constexpr int load_parts = 20;
/// Soil fails if it moves by this share of the size of the model, or does not come to rest within
/// this number of iterations in all.
constexpr double far_share = 0.1;
constexpr int max_slow_iterations = 100;
/// Largest Poisson's ratio, as elastic soil must be compressible.
constexpr double max_poisson = 0.45;

template <int Dim>
void take_stress(const StepEquilibrium<Dim>& step, SolidPoints<Dim>& points, int threads) {
  const Increments<Dim> increments = step.law_increments();
  for_each_index(points.size(), threads, [&](int p) {
    const auto& [law, parameters] = step.skeleton()[p];
    points.skeleton[p] =
        skeleton_response<Dim>(*law, parameters, points.skeleton[p], increments[points.element[p]])
            .state;
  });
}

/// Applies the loads in parts, each repeatedly until the points carry it without displacement.
template <int Dim>
bool settle(const Grid<Dim>& grid, const std::vector<PointSkeleton>& skeleton,
            const Supports<Dim>& supports, const StartLoads<Dim>& loads, int parts,
            SolidPoints<Dim>& points, int threads) {
  StepEquilibrium<Dim> step(grid, points, skeleton, supports, threads);
  for (int part = 1; part <= parts; ++part) {
    const double share = static_cast<double>(part) / parts;
    NodeVectors<Dim> forces = loads.forces;
    for (Vector<Dim>& force : forces) force *= share;
    std::vector<double> pressure = loads.pressure;
    for (double& p : pressure) p *= share;
    std::vector<Vector<Dim>> weight = loads.weight;
    for (Vector<Dim>& of_element : weight) of_element *= share;
    step.set_weight(weight);
    for (int pass = 0;; ++pass) {
      if (pass == max_passes || !step.solve(forces, pressure)) return false;
      if (step.iterations() == 0) break;
      take_stress(step, points, threads);
      step.restart();
    }
  }
  return true;
}

/// Applies all loads to the present stress, by pseudo-time where Newton's method fails.
template <int Dim>
StartStress settle_slowly(const Grid<Dim>& grid, const std::vector<PointSkeleton>& skeleton,
                          const Supports<Dim>& supports, const StartLoads<Dim>& loads,
                          SolidPoints<Dim>& points, int threads) {
  SettlingLimits<Dim> limits{.tolerance = NewtonLimits().tolerance,
                             .far = far_share * extent(grid.mesh).norm(),
                             .max_iterations = max_slow_iterations};
  StepEquilibrium<Dim> step(grid, points, skeleton, supports, threads);
  step.set_weight(loads.weight);
  while (limits.max_iterations > 0) {
    if (!step.solve(loads.forces, loads.pressure)) {
      if (!step.settle(loads.forces, loads.pressure, limits)) break;
    }
    if (step.iterations() == 0) return {.stands = true};
    limits.max_iterations -= step.iterations();
    take_stress(step, points, threads);
    step.restart();
  }
  return {.worst_node = step.worst_node()};
}

/// Keeps the vertical stress of the points and sets the horizontal stress to K_0 times it.
template <int Dim>
void set_earth_pressure(const std::vector<PointSkeleton>& elastic,
                        const std::vector<PointSkeleton>& skeleton, const StartLoads<Dim>& loads,
                        SolidPoints<Dim>& points) {
  const Eigen::Vector3d vertical = Eigen::Vector3d(loads.gravity.data()).normalized();
  const double ratio = *loads.earth_pressure;
  for (int p = 0; p < points.size(); ++p) {
    const auto& [law, parameters] = elastic[p];
    const Eigen::Matrix3d stress =
        skeleton_response<Dim>(*law, parameters, points.skeleton[p],
                               Eigen::Matrix<double, Dim, Dim>::Identity())
            .stress;
    const double vertical_stress = vertical.dot(stress * vertical);
    points.skeleton[p].elastic_b =
        elastic_b_under(skeleton[p].parameters,
                        vertical_stress * (ratio * Eigen::Matrix3d::Identity() +
                                           (1.0 - ratio) * vertical * vertical.transpose()));
  }
}

/// Points yield in place, as far as their law demands.
template <int Dim>
void yield(const std::vector<PointSkeleton>& skeleton, SolidPoints<Dim>& points, int threads) {
  for_each_index(points.size(), threads, [&](int p) {
    const auto& [law, parameters] = skeleton[p];
    points.skeleton[p] = skeleton_response<Dim>(*law, parameters, points.skeleton[p],
                                                Eigen::Matrix<double, Dim, Dim>::Identity())
                             .state;
  });
}

}  // namespace

template <int Dim>
StartStress find_start_stress(const Grid<Dim>& grid, const std::vector<PointSkeleton>& skeleton,
                              const Supports<Dim>& supports, const StartLoads<Dim>& loads,
                              SolidPoints<Dim>& points, int threads) {
  std::vector<PointSkeleton> elastic = skeleton;
  for (PointSkeleton& of_point : elastic) {
    of_point.law = skeleton_law("elastic");
    if (!loads.earth_pressure) continue;
    const double ratio = *loads.earth_pressure;
    of_point.parameters.poisson = std::min(max_poisson, ratio / (1.0 + ratio));
  }
  const auto from_rest = [&](const std::vector<PointSkeleton>& soil, int parts) {
    std::ranges::fill(points.skeleton, SkeletonState());
    return settle(grid, soil, supports, loads, parts, points, threads);
  };
  const auto elastic_stress = [&] {
    const bool found = from_rest(elastic, 1) || from_rest(elastic, load_parts);
    if (found && loads.earth_pressure) set_earth_pressure(elastic, skeleton, loads, points);
    return found;
  };
  const bool found =
      elastic_stress() && settle(grid, skeleton, supports, loads, 1, points, threads);
  if (found || from_rest(skeleton, load_parts)) return {.stands = true};
  if (!elastic_stress()) std::ranges::fill(points.skeleton, SkeletonState());
  yield(skeleton, points, threads);
  const std::vector<SkeletonState> yielded = points.skeleton;
  const StartStress slow = settle_slowly(grid, skeleton, supports, loads, points, threads);
  if (!slow.stands) points.skeleton = yielded;
  return slow;
}

template StartStress find_start_stress(const Grid<2>&, const std::vector<PointSkeleton>&,
                                       const Supports<2>&, const StartLoads<2>&, SolidPoints<2>&,
                                       int);
template StartStress find_start_stress(const Grid<3>&, const std::vector<PointSkeleton>&,
                                       const Supports<3>&, const StartLoads<3>&, SolidPoints<3>&,
                                       int);

}  // namespace suffuse

#include "deformation/strength_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace suffuse {
namespace {

/// Largest displacement of the elastic body in trials, over the size of the smallest element.
constexpr double elastic_displacement = 1e-5;

/// In the place of `soft_share`: a trial takes all loads in one step, in which partial elements
/// must not carry what the soil cannot.
constexpr double soft_in_trials = 1e-6;

template <int Dim>
double largest(const NodeVectors<Dim>& vectors) {
  double result = 0.0;
  for (const Vector<Dim>& v : vectors) result = std::max(result, v.norm());
  return result;
}

/// Of the smallest element, m.
template <int Dim>
double element_size(const Grid<Dim>& grid) {
  return std::pow(std::ranges::min(grid.volume), 1.0 / Dim);
}

template <int Dim>
std::vector<double> components(const NodeVectors<Dim>& vectors) {
  std::vector<double> result;
  for (const Vector<Dim>& v : vectors) result.insert(result.end(), v.begin(), v.end());
  return result;
}

template <int Dim>
class StrengthReduction {
 public:
  StrengthReduction(const SolidBody<Dim>& body, const Supports<Dim>& supports,
                    const NodeVectors<Dim>& loads, const std::vector<double>& pressure, int threads,
                    const StrengthReductionLimits& limits)
      : body_(body),
        supports_(supports),
        loads_(loads),
        pressure_(pressure),
        threads_(threads),
        limits_(limits),
        points_(body.points),
        skeleton_(body.skeleton),
        held_(loads.size(), Vector<Dim>::Zero()) {
    for (Eigen::Matrix3d& b : points_.elastic_b) b.setIdentity();
    find_stiffness();
  }

  SafetyFactor find() {
    double factor = 1.0;
    bool from_rest = true;
    while (factor >= limits_.least && factor <= limits_.largest) {
      attempt(factor, from_rest);
      from_rest = false;
      const double fails = next_failure();
      if (std::isinf(fails)) {
        factor = 2.0 * result_.holds;
      } else if (result_.holds == 0.0) {
        factor = 0.5 * fails;
      } else if (fails > (1.0 + limits_.tolerance) * result_.holds) {
        factor = std::sqrt(result_.holds * fails);
      } else if (const Failure& failure = failed_.at(fails);
                 failure.start < result_.holds || !failure.from_rest) {
        // Once more: Newton's method may have given up too early.
        factor = fails;
        from_rest = failure.start == result_.holds;
      } else {
        break;
      }
    }
    result_.fails = next_failure();
    if (!std::isinf(result_.fails)) {
      result_.mechanism = components(failed_.at(result_.fails).displacement);
    }
    result_.factor = result_.holds == 0.0 ? 0.0 : std::sqrt(result_.holds * result_.fails);
    return result_;
  }

 private:
  /// Trials of a factor that failed.
  struct Failure {
    double start = 0.0;  ///< the largest factor from whose equilibrium one started; 0: none
    bool from_rest = false;
    NodeVectors<Dim> displacement;  ///< when the last was given up, beyond that of elastic soil, m
  };

  /// One trial, from the equilibrium of the largest factor that holds, or from no displacement.
  void attempt(double factor, bool from_rest) {
    const NodeVectors<Dim> rest(loads_.size(), Vector<Dim>::Zero());
    NewtonSolution<Dim> solution = solve(factor, from_rest ? rest : held_);
    result_.trials.push_back(judged(factor, solution));
    if (result_.trials.back().holds) {
      result_.holds = factor;
      held_ = std::move(solution.displacement);
      return;
    }
    Failure& failure = failed_[factor];
    failure.from_rest = failure.from_rest || from_rest;
    if (!from_rest) failure.start = result_.holds;
    failure.displacement = std::move(solution.displacement);
    for (std::size_t i = 0; i < elastic_.size(); ++i) failure.displacement[i] -= elastic_[i];
  }

  /// Of the factors above the largest that holds, the smallest whose trial failed. Infinite: no
  /// trial failed.
  [[nodiscard]] double next_failure() const {
    const auto next = failed_.upper_bound(result_.holds);
    return next == failed_.end() ? std::numeric_limits<double>::infinity() : next->first;
  }

  /// Makes the soil so stiff that the elastic body keeps its shape.
  void find_stiffness() {
    const SkeletonLaw* const elastic = skeleton_law("elastic");
    double young = 0.0;
    for (const PointSkeleton& point : body_.skeleton) {
      young = std::max(young, point.parameters.young);
    }
    double force = 0.0;
    for (const Vector<Dim>& f : loads_) force += f.norm();
    for (PointSkeleton& point : skeleton_) point.law = elastic;
    // First so much that the sum of all forces would hardly move one element.
    const double size = element_size(body_.grid);
    stiffness_ = 1e6 * std::max(force / std::pow(size, Dim - 1), 1.0) / young;
    elastic_max_ = elastic_displacement * size;
    elastic_ = solve(1.0, held_).displacement;
    const double first = largest<Dim>(elastic_);
    if (first > 0.0) {
      stiffness_ *= first / elastic_max_;
      for (Vector<Dim>& u : elastic_) u *= elastic_max_ / first;
    }
    for (std::size_t p = 0; p < skeleton_.size(); ++p) skeleton_[p].law = body_.skeleton[p].law;
  }

  void set_strength(double factor) {
    for (std::size_t p = 0; p < skeleton_.size(); ++p) {
      skeleton_[p].parameters = reduced_strength(body_.skeleton[p].parameters, factor);
      skeleton_[p].parameters.young *= stiffness_;
    }
  }

  NewtonSolution<Dim> solve(double factor, const NodeVectors<Dim>& start) {
    set_strength(factor);
    const SolidBody<Dim> body{body_.grid, points_,       body_.sorted,
                              skeleton_,  body_.classes, soft_in_trials};
    Equilibrium<Dim> equilibrium(body, supports_, threads_);
    equilibrium.set_pressure(pressure_);
    return EquilibriumSolver<Dim>(equilibrium).solve(loads_, start, limits_.newton);
  }

  [[nodiscard]] StrengthTrial judged(double factor, const NewtonSolution<Dim>& solution) const {
    StrengthTrial trial{
        .factor = factor, .converged = solution.converged, .iterations = solution.iterations()};
    const double displacement = largest<Dim>(solution.displacement);
    trial.displacement_max = displacement * stiffness_;
    trial.holds = solution.converged && displacement <= limits_.runaway * elastic_max_;
    return trial;
  }

  const SolidBody<Dim>& body_;
  const Supports<Dim>& supports_;
  const NodeVectors<Dim>& loads_;
  const std::vector<double>& pressure_;
  int threads_;
  const StrengthReductionLimits& limits_;
  SolidPoints<Dim> points_;  ///< without stress
  std::vector<PointSkeleton> skeleton_;
  NodeVectors<Dim> held_;  ///< displacement in the trial of the largest factor that holds
  std::map<double, Failure> failed_;  ///< by their factors
  double stiffness_ = 1.0;            ///< of trials over that of the soil
  NodeVectors<Dim> elastic_;          ///< displacement of the elastic body in trials, m
  SafetyFactor result_;
  double elastic_max_ = 0.0;  ///< largest displacement of the elastic body in trials, m
};

}  // namespace

SkeletonParameters reduced_strength(const SkeletonParameters& parameters, double factor) {
  SkeletonParameters result = parameters;
  result.cohesion /= factor;
  result.friction = std::atan(std::tan(parameters.friction) / factor);
  result.dilation = std::min(parameters.dilation, result.friction);
  return result;
}

template <int Dim>
SafetyFactor find_safety_factor(const SolidBody<Dim>& body, const Supports<Dim>& supports,
                                const NodeVectors<Dim>& loads, const std::vector<double>& pressure,
                                int threads, const StrengthReductionLimits& limits) {
  return StrengthReduction<Dim>(body, supports, loads, pressure, threads, limits).find();
}

template SafetyFactor find_safety_factor(const SolidBody<2>&, const Supports<2>&,
                                         const NodeVectors<2>&, const std::vector<double>&, int,
                                         const StrengthReductionLimits&);
template SafetyFactor find_safety_factor(const SolidBody<3>&, const Supports<3>&,
                                         const NodeVectors<3>&, const std::vector<double>&, int,
                                         const StrengthReductionLimits&);

}  // namespace suffuse

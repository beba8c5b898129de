#include "tools/strength_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>

#include "equilibrium/quadratic_equilibrium.hpp"

namespace suffuse {
namespace {

/// Largest displacement of the elastic body in trials, over the size of the model.
constexpr double elastic_strain = 1e-6;
/// Forces out of balance in a trial that holds, over the loads of the smallest element. Round-off
/// forbids a smaller residual than the other one.
constexpr double balanced_share = 1e-2;
constexpr double least_residual = 2e-11;

/// Trials apply all loads in one step, in which partially filled elements must not carry loads
/// that the soil cannot.
const SoftStiffness soft_in_trials{.gradient = 1e-6};
/// Speed of soil that counts as at rest when the iterations of a trial end, over the elastic
/// displacement in a unit of pseudo-time: forces of this share of the loads are out of balance.
constexpr double slow_share = 3e-4;
/// Share of its loads with which soil counts that hardly moves.
constexpr double idle_share = 1e-4;
/// Elastic displacement, over its mean weighted by loads, beyond which hardly any soil holds a
/// node. With moved soil this happens where one point has just entered an empty element.
constexpr double loose_displacement = 100.0;

template <int Dim>
std::vector<double> components(const NodeVectors<Dim>& vectors) {
  std::vector<double> result;
  for (const Vector<Dim>& v : vectors) result.insert(result.end(), v.begin(), v.end());
  return result;
}

template <int Dim>
SolidPoints<Dim> without_stress(SolidPoints<Dim> points) {
  for (SkeletonState& state : points.skeleton) state.elastic_b.setIdentity();
  return points;
}

template <int Dim>
class StrengthReduction {
 public:
  StrengthReduction(const SolidBody<Dim>& body, const Supports<Dim>& supports,
                    const NodalLoads<Dim>& loads, const std::vector<double>& pressure, int threads,
                    const StrengthReductionLimits& limits, const std::vector<double>& kept_cohesion)
      : body_(body),
        supports_(supports),
        shapes_(loads.shapes()),
        loads_(loads.forces()),
        pressure_(pressure),
        threads_(threads),
        limits_(limits),
        kept_cohesion_(kept_cohesion),
        points_(without_stress(body.points)),
        skeleton_(body.skeleton),
        loose_(loads_.size(), 0) {
    find_modulus();
  }

  SafetyFactor find() {
    result_.fails = std::numeric_limits<double>::infinity();
    double factor = 1.0;
    while (factor >= limits_.least && factor <= limits_.largest &&
           result_.fails > (1.0 + limits_.tolerance) * result_.holds) {
      attempt(factor);
      if (static_cast<int>(undecided_.size()) == limits_.most_undecided) return result_;
      factor = next_factor();
    }
    result_.undecided_node = -1;
    result_.factor = result_.holds == 0.0 ? 0.0 : std::sqrt(result_.holds * result_.fails);
    return result_;
  }

 private:
  [[nodiscard]] double next_factor() const {
    // Undecided factors between the bounds.
    const auto first = undecided_.upper_bound(result_.holds);
    const auto last = undecided_.lower_bound(result_.fails);
    const double below = first == last ? result_.fails : *first;
    const double above = first == last ? result_.holds : *std::prev(last);
    if (std::isinf(result_.fails)) return 2.0 * above;
    if (result_.holds == 0.0) return 0.5 * below;
    const bool upper = result_.fails * result_.holds > below * above;
    return upper ? std::sqrt(above * result_.fails) : std::sqrt(result_.holds * below);
  }

  /// One trial, from the equilibrium of the largest factor that holds.
  void attempt(double factor) {
    set_strength(factor);
    const auto equilibrium = balance();
    NewtonSolution<Dim> solution =
        EquilibriumSolver<Dim>(*equilibrium, kept_).solve(loads_, held_, newton_);
    SettledSoil<Dim> soil;
    soil.residual = solution.residuals.back();
    soil.iterations = solution.iterations();
    if (solution.converged) {
      soil.motion = solution.displacement;
      for (std::size_t i = 0; i < held_.size(); ++i) soil.motion[i] -= held_[i];
      soil.end = elastic_share(*equilibrium, soil.motion) > limits_.runaway ? Settling::runs_away
                                                                            : Settling::rests;
      soil.displacement = std::move(solution.displacement);
    } else {
      soil = PseudoTime<Dim>(*equilibrium, loads_)
                 .settle(held_,
                         {.tolerance = newton_.tolerance,
                          .far = limits_.runaway,
                          .slow = slow_share,
                          .size = [&](const auto& way) { return elastic_share(*equilibrium, way); },
                          .max_iterations = limits_.settling_iterations});
      soil.iterations += solution.iterations();
    }
    note(factor, std::move(soil));
  }

  /// Largest length of a displacement over that of the elastic displacement under the loads of the
  /// soil that moves. Deep ground below this soil hardly changes it.
  [[nodiscard]] double elastic_share(const ForceBalance<Dim>& body, NodeVectors<Dim> way) {
    way = without_loose(std::move(way));
    const double largest = largest_length<Dim>(way);
    if (largest == 0.0) return 0.0;
    NodeVectors<Dim> loads = driving_;
    for (std::size_t i = 0; i < loads.size(); ++i) {
      loads[i] *= std::max(way[i].norm() / largest, idle_share);
    }
    Eigen::VectorXd elastic;
    kept_->system.solve_nearly(body.unknowns().components(loads), elastic);
    return largest / largest_length<Dim>(without_loose(body.unknowns().vectors(elastic)));
  }

  void note(double factor, SettledSoil<Dim> soil) {
    const double displacement = largest_length<Dim>(without_loose(soil.displacement));
    result_.trials.push_back({.factor = factor,
                              .end = soil.end,
                              .displacement_max = displacement * modulus_ / mean_modulus_,
                              .residual = soil.residual,
                              .iterations = soil.iterations});
    if (soil.end == Settling::rests) {
      result_.holds = factor;
      held_ = std::move(soil.displacement);
    } else if (soil.end == Settling::runs_away) {
      result_.fails = factor;
      soil.motion.resize(body_.grid.mesh.nodes.size());  // without edges
      result_.mechanism = components(soil.motion);
    } else {
      result_.undecided_node = shapes_ ? shapes_->ends(soil.worst_node)[0] : soil.worst_node;
      undecided_.insert(factor);
    }
  }

  /// Finds the modulus of trials and how exactly the forces must balance.
  void find_modulus() {
    const double smallest = std::ranges::min(body_.grid.volume);
    double force = 0.0;
    for (const Vector<Dim>& f : loads_) force += f.norm();
    for (const PointSkeleton& point : body_.skeleton) mean_modulus_ += point.parameters.young;
    mean_modulus_ /= static_cast<double>(body_.skeleton.size());
    // With the first modulus the sum of all forces would hardly deform one element.
    modulus_ = 1e6 * std::max(force / std::pow(smallest, 1.0 - 1.0 / Dim), 1.0);
    find_elastic_displacement();
    find_loose(force);
    const double largest = largest_length<Dim>(without_loose(held_));
    if (largest > 0.0) {
      const double share = elastic_strain * extent(body_.grid.mesh).norm() / largest;
      for (Vector<Dim>& u : held_) u *= share;
      modulus_ /= share;
    }
    set_strength(1.0);
    Eigen::SparseMatrix<double> stiffness;
    const auto equilibrium = balance();
    equilibrium->share_pattern(kept_->pattern);
    equilibrium->assemble_elastic(stiffness);
    kept_->system.factorise(stiffness);
    const auto& volume = body_.points.reference_volume;
    double load = 0.0;  // N/m3
    for (const Vector<Dim>& f : driving_) load += f.norm();
    load /= std::reduce(volume.begin(), volume.end());
    newton_.tolerance = std::clamp(balanced_share * load * smallest / equilibrium->force_scale(),
                                   least_residual, limits_.newton.tolerance);
  }

  void find_elastic_displacement() {
    for (PointSkeleton& point : skeleton_) point.law = skeleton_law("elastic");
    set_strength(1.0);
    const auto equilibrium = balance();
    held_.assign(loads_.size(), Vector<Dim>::Zero());
    equilibrium->displace(held_, false);
    driving_ = equilibrium->forces();
    for (std::size_t i = 0; i < driving_.size(); ++i) driving_[i] = loads_[i] - driving_[i];
    held_ = EquilibriumSolver<Dim>(*equilibrium)
                .solve(loads_, held_, {.max_iterations = 3, .tolerance = 0.0})
                .displacement;
    for (std::size_t p = 0; p < skeleton_.size(); ++p) skeleton_[p].law = body_.skeleton[p].law;
  }

  void find_loose(double force) {
    double sum = 0.0;
    for (std::size_t i = 0; i < loads_.size(); ++i) sum += loads_[i].norm() * held_[i].norm();
    for (std::size_t i = 0; i < loose_.size(); ++i) {
      loose_[i] = held_[i].norm() * force > loose_displacement * sum ? 1 : 0;
    }
    for (int i = 0; shapes_ && i < shapes_->size(); ++i) {
      for (const int end : shapes_->ends(i)) loose_[i] = std::max(loose_[i], loose_[end]);
    }
  }

  [[nodiscard]] NodeVectors<Dim> without_loose(NodeVectors<Dim> vectors) const {
    for (std::size_t i = 0; i < vectors.size(); ++i) {
      if (loose_[i] != 0) vectors[i].setZero();
    }
    return vectors;
  }

  void set_strength(double factor) {
    for (std::size_t p = 0; p < skeleton_.size(); ++p) {
      skeleton_[p].parameters = reduced_strength(body_.skeleton[p].parameters, factor);
      skeleton_[p].parameters.young = modulus_;
      if (!kept_cohesion_.empty()) skeleton_[p].parameters.cohesion += kept_cohesion_[p];
    }
  }

  /// Forces of the soil with its present strength.
  [[nodiscard]] std::unique_ptr<ForceBalance<Dim>> balance() const {
    const SolidBody<Dim> body{body_.grid,    points_,        body_.sorted, skeleton_,
                              body_.classes, soft_in_trials, body_.weight};
    if (shapes_) {
      auto quadratic =
          std::make_unique<QuadraticEquilibrium<Dim>>(body, supports_, *shapes_, threads_);
      quadratic->set_pressure(pressure_);
      return quadratic;
    }
    auto linear = std::make_unique<Equilibrium<Dim>>(body, supports_, threads_);
    linear->set_pressure(pressure_);
    return linear;
  }

  const SolidBody<Dim>& body_;
  const Supports<Dim>& supports_;
  const std::shared_ptr<const QuadraticShapes<Dim>> shapes_;  ///< null: linear displacements
  const NodeVectors<Dim>& loads_;
  const std::vector<double>& pressure_;
  int threads_;
  const StrengthReductionLimits& limits_;
  const std::vector<double>& kept_cohesion_;
  SolidPoints<Dim> points_;              ///< without stress
  std::vector<PointSkeleton> skeleton_;  ///< of the present trial
  std::shared_ptr<KeptStiffness<Dim>> kept_ = std::make_shared<KeptStiffness<Dim>>();
  NodeVectors<Dim> driving_;  ///< loads and pore pressures on soil without stress, N
  /// Displacement in the trial of the largest factor that holds, m; that of the elastic body first.
  NodeVectors<Dim> held_;
  NewtonLimits newton_ = limits_.newton;
  double mean_modulus_ = 0.0;  ///< Young's of the soil, Pa
  double modulus_ = 0.0;       ///< Young's in trials, Pa
  std::vector<char> loose_;    ///< per node: whether hardly any soil holds it
  SafetyFactor result_;
  std::set<double> undecided_;
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
                                const NodalLoads<Dim>& loads, const std::vector<double>& pressure,
                                int threads, const StrengthReductionLimits& limits,
                                const std::vector<double>& kept_cohesion) {
  return StrengthReduction<Dim>(body, supports, loads, pressure, threads, limits, kept_cohesion)
      .find();
}

template SafetyFactor find_safety_factor(const SolidBody<2>&, const Supports<2>&,
                                         const NodalLoads<2>&, const std::vector<double>&, int,
                                         const StrengthReductionLimits&,
                                         const std::vector<double>&);
template SafetyFactor find_safety_factor(const SolidBody<3>&, const Supports<3>&,
                                         const NodalLoads<3>&, const std::vector<double>&, int,
                                         const StrengthReductionLimits&,
                                         const std::vector<double>&);

}  // namespace suffuse

#include "equilibrium/pseudo_time.hpp"

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"

namespace suffuse {
namespace {

/// Length of the first step: elastic soil moves half of its way to rest in it.
constexpr double first_length = 1.0;
/// Shorter steps, which have no effect on elastic soil, are given up.
constexpr double least_length = 1e-4;
/// Largest defect of a step, relative to the unbalanced forces at its start.
constexpr double step_accuracy = 0.03;
/// Accuracy of linear solutions, relative to their right-hand side.
constexpr double linear_accuracy = 3e-3;
constexpr int max_step_iterations = 8;
/// The lengths of steps aim at this number of iterations, for which the total work is least.
constexpr double good_iterations = 4.0;
/// Lengths of consecutive steps differ by this factor at most.
constexpr double growth = 4.0;
/// The motion decides if the last two quarters of the iterations last at least this long each:
/// elastic soil has come to rest in a small part of this time.
constexpr double long_enough = 500.0;
/// Soil whose speed in the last quarter is at least this share of that in the third does not slow
/// down.
constexpr double constant_speed = 0.75;
/// Most halvings of Newton's step; beyond that a shorter step is better.
constexpr int max_step_halvings = 6;
/// The defect must fall by this share of the linear model's prediction (Armijo's rule).
constexpr double least_fall = 1e-4;

}  // namespace

template <int Dim>
PseudoTime<Dim>::PseudoTime(ForceBalance<Dim>& equilibrium, const NodeVectors<Dim>& loads)
    : equilibrium_(equilibrium), loads_(loads) {
  equilibrium_.assemble_elastic(elastic_);
  system_.factorise(elastic_);
}

template <int Dim>
SettledSoil<Dim> PseudoTime<Dim>::settle(NodeVectors<Dim> start,
                                         const SettlingLimits<Dim>& limits) {
  soil_ = {};
  soil_.displacement = start;
  start_ = std::move(start);
  soil_.motion.assign(loads_.size(), Vector<Dim>::Zero());
  length_ = first_length;
  last_length_ = time_ = 0.0;
  samples_.clear();
  equilibrium_.displace(soil_.displacement, true);
  judge(limits);
  while (soil_.end == Settling::undecided && length_ >= least_length &&
         soil_.iterations < limits.max_iterations) {
    if (step(limits.max_iterations - soil_.iterations)) {
      judge(limits);
      time_ += last_length_;
      const double sampled = 0.5 + 0.25 * static_cast<double>(samples_.size());
      if (samples_.size() < 2 && soil_.iterations >= sampled * limits.max_iterations) {
        samples_.push_back({time_, soil_.displacement});
      }
      length_ *= std::min(good_iterations / std::max(step_iterations_, 1), growth);
    } else {
      equilibrium_.displace(soil_.displacement, true);
      length_ *= 0.5;
    }
  }
  if (soil_.end == Settling::undecided && samples_.size() == 2) judge_motion(limits);
  return soil_;
}

template <int Dim>
Eigen::VectorXd PseudoTime<Dim>::unbalanced() const {
  const DisplacementUnknowns<Dim>& unknowns = equilibrium_.unknowns();
  return unknowns.components(loads_) - unknowns.components(equilibrium_.forces());
}

/// Displacement since the start of the step, along the unknowns.
template <int Dim>
Eigen::VectorXd PseudoTime<Dim>::moved_by(const NodeVectors<Dim>& displacement) const {
  const DisplacementUnknowns<Dim>& unknowns = equilibrium_.unknowns();
  return unknowns.components(displacement) - unknowns.components(soil_.displacement);
}

/// Displacement at constant speed, as of soil that fails.
template <int Dim>
NodeVectors<Dim> PseudoTime<Dim>::predicted() const {
  NodeVectors<Dim> result = soil_.displacement;
  const double share = last_length_ > 0.0 ? length_ / last_length_ : 0.0;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += share * soil_.motion[i];
  return result;
}

/// Sets the defect of backward Euler at a displacement; false if that is not possible.
template <int Dim>
bool PseudoTime<Dim>::take(const NodeVectors<Dim>& displacement, Eigen::VectorXd& defect) {
  if (!equilibrium_.is_possible(displacement)) return false;
  equilibrium_.displace(displacement, true);
  defect = unbalanced() - elastic_ * moved_by(displacement) / length_;
  return true;
}

/// Takes one step of the soil; false if it is too long.
template <int Dim>
bool PseudoTime<Dim>::step(int max_iterations) {
  step_iterations_ = 0;
  trial_ = predicted();
  Eigen::VectorXd defect;
  if (!take(trial_, defect) || !(defect.norm() < unbalanced_.norm())) {
    trial_ = soil_.displacement;
    take(trial_, defect);
  }
  const int most = std::min(max_step_iterations, max_iterations);
  while (!(defect.norm() <= step_accuracy * unbalanced_.norm())) {
    if (step_iterations_ == most) return false;
    ++step_iterations_;
    ++soil_.iterations;
    if (!improve(defect)) return false;
  }
  for (std::size_t i = 0; i < trial_.size(); ++i) {
    soil_.motion[i] = trial_[i] - soil_.displacement[i];
  }
  soil_.displacement = trial_;
  last_length_ = length_;
  return true;
}

/// One iteration of Newton's method. Returns false if no part of its step reduces the defect.
template <int Dim>
bool PseudoTime<Dim>::improve(Eigen::VectorXd& defect) {
  equilibrium_.assemble(matrix_);
  const auto values = [](Eigen::SparseMatrix<double>& of) {
    return Eigen::Map<Eigen::VectorXd>(of.valuePtr(), of.nonZeros());
  };
  values(matrix_) += values(elastic_) / length_;
  Eigen::VectorXd step;
  try {
    system_.solve(matrix_, defect, step, linear_accuracy);
  } catch (const NumericalError&) {
    return false;
  }
  const double before = defect.norm();
  double share = 1.0;
  for (int halving = 0; halving <= max_step_halvings; ++halving, share *= 0.5) {
    NodeVectors<Dim> shorter = trial_;
    equilibrium_.unknowns().add(step, share, shorter);
    if (!take(shorter, defect)) continue;
    if (!(defect.norm() <= (1.0 - least_fall * share) * before)) continue;
    trial_ = std::move(shorter);
    return true;
  }
  return false;
}

/// Finds the residual at the present displacement, and whether the soil rests or runs away.
template <int Dim>
void PseudoTime<Dim>::judge(const SettlingLimits<Dim>& limits) {
  unbalanced_ = unbalanced();
  soil_.residual = unbalanced_.norm() / (equilibrium_.force_scale() + norm<Dim>(loads_));
  if (limits.size(way_from(start_)) > limits.far) {
    soil_.end = Settling::runs_away;
  } else if (soil_.residual <= limits.tolerance) {
    soil_.end = Settling::rests;
  }
  soil_.worst_node = equilibrium_.unknowns().longest(unbalanced_);
}

template <int Dim>
NodeVectors<Dim> PseudoTime<Dim>::way_from(const NodeVectors<Dim>& earlier) const {
  NodeVectors<Dim> way = soil_.displacement;
  for (std::size_t i = 0; i < way.size(); ++i) way[i] -= earlier[i];
  return way;
}

template <int Dim>
void PseudoTime<Dim>::judge_motion(const SettlingLimits<Dim>& limits) {
  const Sample& first = samples_.front();
  const Sample& middle = samples_.back();
  const double third_quarter = middle.time - first.time;
  const double last_quarter = time_ - middle.time;
  if (limits.slow == 0.0 || std::min(third_quarter, last_quarter) < long_enough) return;
  const NodeVectors<Dim> late = way_from(middle.displacement);
  NodeVectors<Dim> early = way_from(first.displacement);
  for (std::size_t i = 0; i < early.size(); ++i) early[i] -= late[i];
  const double speed = limits.size(late) / last_quarter;
  if (speed <= limits.slow) {
    soil_.end = Settling::rests;
  } else if (speed >= constant_speed * limits.size(early) / third_quarter) {
    soil_.end = Settling::runs_away;
  }
}

template class PseudoTime<2>;
template class PseudoTime<3>;

}  // namespace suffuse

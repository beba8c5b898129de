#include "bounds/goal.hpp"

#include <cmath>

namespace suffuse {
namespace {

/// Share of the fluxes that there are, and that there could be, by which intervals are wider: for
/// the round-off in them.
constexpr double interval_margin = 1e-13;

/// Mean of the two ways to correct the number by its dual.
template <int Dim>
double corrected(const SeepageProblem<Dim>& problem, const Goal& goal, const FieldPair<Dim>& dual) {
  const SeepageEnergy<Dim>& energy = problem.energy();
  const FieldPair<Dim>& flow = problem.flow();
  const auto [given, held] = problem.products(dual);
  const double by_heads = goal.of_heads - energy.inner(flow.of_head, dual.of_head) - given;
  const double by_fluxes = goal.of_fluxes + held + energy.inner(flow.of_flux, dual.of_flux);
  return 0.5 * (by_heads + by_fluxes);
}

}  // namespace

template <int Dim>
double margin_of(const SeepageProblem<Dim>& problem) {
  return interval_margin * (problem.all_fluxes() + problem.largest_flux());
}

template <int Dim>
double norm(const SeepageEnergy<Dim>& energy, const Slopes<Dim>& slopes) {
  return std::sqrt(energy.inner(slopes, slopes));
}

template <int Dim>
Interval bound(const SeepageProblem<Dim>& problem, const Goal& goal, const FieldPair<Dim>& dual) {
  const double middle = corrected(problem, goal, dual);
  const double half =
      0.5 * problem.gap_norm() * norm(problem.energy(), dual.gap()) + margin_of(problem);
  return {middle - half, middle + half};
}

template <int Dim>
Interval estimate(const SeepageProblem<Dim>& problem, const Goal& goal,
                  const FieldPair<Dim>& dual) {
  const SeepageEnergy<Dim>& energy = problem.energy();
  const Slopes<Dim> dual_gap = dual.gap();
  const std::vector<double> of_flow = energy.per_element(problem.gap(), problem.gap());
  const std::vector<double> of_dual = energy.per_element(dual_gap, dual_gap);
  double half = 0.0;
  for (std::size_t e = 0; e < of_flow.size(); ++e) half += 0.5 * std::sqrt(of_flow[e] * of_dual[e]);
  const double middle = corrected(problem, goal, dual);
  return {middle - half, middle + half};
}

template <int Dim>
StepEstimates step_estimates(const SeepageProblem<Dim>& problem, const Goal& goal,
                             const FieldPair<Dim>& dual) {
  const std::vector<double>& change = problem.state().step.conductivity;
  double by_conductivity = 0.0;
  if (!change.empty()) {
    // Walls do not erode.
    Slopes<Dim> dual_slopes = dual.of_head;
    for (auto& across_wall : dual_slopes.wall) across_wall.fill(0.0);
    const std::vector<double> parts =
        problem.energy().per_element(problem.flow().of_flux, dual_slopes);
    for (std::size_t e = 0; e < change.size(); ++e) by_conductivity += change[e] * parts[e];
  }
  return {std::abs(goal.in_time), std::abs(by_conductivity)};
}

template double margin_of(const SeepageProblem<2>&);
template double norm(const SeepageEnergy<2>&, const Slopes<2>&);
template Interval bound(const SeepageProblem<2>&, const Goal&, const FieldPair<2>&);
template Interval estimate(const SeepageProblem<2>&, const Goal&, const FieldPair<2>&);
template StepEstimates step_estimates(const SeepageProblem<2>&, const Goal&, const FieldPair<2>&);

template double margin_of(const SeepageProblem<3>&);
template double norm(const SeepageEnergy<3>&, const Slopes<3>&);
template Interval bound(const SeepageProblem<3>&, const Goal&, const FieldPair<3>&);
template Interval estimate(const SeepageProblem<3>&, const Goal&, const FieldPair<3>&);
template StepEstimates step_estimates(const SeepageProblem<3>&, const Goal&, const FieldPair<3>&);

}  // namespace suffuse

#include "bounds/discharge_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "bounds/goal.hpp"
#include "bounds/probe_means.hpp"
#include "bounds/seepage_problem.hpp"

namespace suffuse {
namespace {

/// The flow of a unit head at each group of boundaries and no head at the others.
template <int Dim>
std::vector<FieldPair<Dim>> duals_of(SeepageProblem<Dim>& problem) {
  const int groups = static_cast<int>(problem.groups().size());
  std::vector<FieldPair<Dim>> duals;
  if (groups == 0) return duals;
  FieldPair<Dim> rest = problem.uniform(1.0);
  const auto add = [&](FieldPair<Dim> dual) {
    rest = problem.combined(std::move(rest), -1.0, dual);
    duals.push_back(std::move(dual));
  };
  if (const auto heads = problem.two_heads()) {
    // The flow itself is the dual, but for its scale.
    const auto [first, second] = *heads;
    const double scale = 1.0 / (first - second);
    add(problem.combined(problem.uniform(-second * scale), scale, problem.flow()));
  } else {
    for (int g = 0; g + 1 < groups; ++g) add(problem.dual({.group = g, .source = {}, .slope = {}}));
  }
  // All of them together are a unit head everywhere.
  duals.push_back(std::move(rest));
  return duals;
}

/// A discharge through faces that hold heads, m3/s, with its dual.
template <int Dim>
struct HeldDischarge {
  Goal goal;
  FieldPair<Dim> dual;
};

template <int Dim>
Interval bound(const SeepageProblem<Dim>& problem, const HeldDischarge<Dim>& discharge) {
  return bound(problem, discharge.goal, discharge.dual);
}

template <int Dim>
StepEstimates step_estimates(const SeepageProblem<Dim>& problem,
                             const HeldDischarge<Dim>& discharge) {
  return step_estimates(problem, discharge.goal, discharge.dual);
}

/// Per group of boundaries.
template <int Dim>
std::vector<HeldDischarge<Dim>> held_discharges(SeepageProblem<Dim>& problem) {
  std::vector<HeldDischarge<Dim>> result;
  for (FieldPair<Dim>& dual : duals_of(problem)) {
    HeldDischarge<Dim> of_group{{}, std::move(dual)};
    for (const int b : problem.groups()[result.size()]) {
      of_group.goal.of_fluxes += problem.crossings()[b].held;
      of_group.goal.in_time += problem.crossings()[b].in_time;
    }
    result.push_back(std::move(of_group));
  }
  return result;
}

/// Sum of what leaves through groups.
template <int Dim>
HeldDischarge<Dim> outflow_of(const SeepageProblem<Dim>& problem,
                              const std::vector<HeldDischarge<Dim>>& groups) {
  HeldDischarge<Dim> sum{{}, problem.uniform(0.0)};
  for (const HeldDischarge<Dim>& group : groups) {
    if (!(group.goal.of_fluxes > 0.0)) continue;
    sum.goal.of_fluxes += group.goal.of_fluxes;
    sum.goal.in_time += group.goal.in_time;
    sum.dual = problem.combined(std::move(sum.dual), 1.0, group.dual);
  }
  return sum;
}

/// The group of which least is known.
template <int Dim>
HeldDischarge<Dim> least_known(const SeepageProblem<Dim>& problem,
                               const std::vector<HeldDischarge<Dim>>& groups) {
  const auto gap = [&](const HeldDischarge<Dim>& group) {
    return norm(problem.energy(), group.dual.gap());
  };
  return *std::ranges::max_element(groups, {}, gap);
}

/// Each element's part in half the product of the gaps of flow and dual.
template <int Dim>
std::vector<double> parts_of_error(const SeepageProblem<Dim>& problem, const FieldPair<Dim>& dual) {
  const SeepageEnergy<Dim>& energy = problem.energy();
  const Slopes<Dim> dual_gap = dual.gap();
  std::vector<double> parts = energy.per_element(problem.gap(), problem.gap());
  const std::vector<double> of_dual = energy.per_element(dual_gap, dual_gap);
  const double ratio = problem.gap_norm() / norm(energy, dual_gap);
  const bool has_ratio = std::isfinite(ratio) && ratio > 0.0;
  for (std::size_t e = 0; e < parts.size(); ++e) {
    parts[e] = has_ratio ? 0.25 * (parts[e] / ratio + ratio * of_dual[e]) : 0.0;
  }
  return parts;
}

}  // namespace

template <int Dim>
DischargeBounds discharge_bounds(const SeepageState<Dim>& state) {
  SeepageProblem<Dim> problem(state);
  DischargeBounds result;
  result.why_estimates = problem.objection();
  result.largest_flux = problem.largest_flux();
  result.error.assign(state.grid.volume.size(), 0.0);
  const double margin = margin_of(problem);
  const double round_off = seepage_round_off * problem.all_fluxes();
  // An interval next to nothing wide is one by balance. It leaves out the errors of stored water.
  const auto is_known = [&](const Interval& q) { return q.half() <= round_off; };
  bool both_ways = false;
  for (const Crossing& crossing : problem.crossings()) {
    result.boundaries.emplace_back(Interval{crossing.given - margin, crossing.given + margin});
    result.boundary_steps.push_back({std::abs(crossing.in_time), 0.0});
    both_ways = both_ways || std::min(crossing.in, crossing.out) > round_off;
  }
  const std::vector<HeldDischarge<Dim>> groups = held_discharges(problem);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::vector<int>& members = problem.groups()[g];
    double out = 0.0;
    double in = 0.0;
    for (const int b : members) {
      const double held = problem.crossings()[b].held;
      (held > 0.0 ? out : in) += std::abs(held);
      if (members.size() > 1) result.boundaries[b].reset();
    }
    both_ways = both_ways || std::min(in, out) > round_off;
    if (members.size() > 1) continue;
    const int b = members.front();
    const Interval of_group = bound(problem, groups[g]);
    std::optional<Interval>& whole = result.boundaries[b];
    whole = {whole->low + of_group.low, whole->high + of_group.high};
    if (is_known(of_group) && !problem.balances()) whole.reset();
    result.boundary_steps[b] = step_estimates(problem, groups[g]);
  }
  HeldDischarge<Dim> held = outflow_of(problem, groups);
  Interval outflow = bound(problem, held);
  const bool is_by_balance = is_known(outflow);
  if (!both_ways && (!is_by_balance || problem.balances())) {
    result.flux_out = outflow;
    for (const Crossing& crossing : problem.crossings()) {
      result.flux_out->low += std::max(0.0, crossing.given);
      result.flux_out->high += std::max(0.0, crossing.given);
    }
  }
  if (!both_ways) result.flux_out_step = step_estimates(problem, held);
  if (groups.size() > 1) {
    if (is_by_balance) {
      held = least_known(problem, groups);
      outflow = bound(problem, held);
    }
    result.least_known = outflow;
    result.error = parts_of_error(problem, held.dual);
  }
  result.probes = probe_means(problem);
  return result;
}

template DischargeBounds discharge_bounds(const SeepageState<2>&);
template DischargeBounds discharge_bounds(const SeepageState<3>&);

}  // namespace suffuse

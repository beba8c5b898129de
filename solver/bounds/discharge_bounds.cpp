#include "bounds/discharge_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "bounds/seepage_problem.hpp"

namespace suffuse {
namespace {

/// Share of the fluxes that there are, and that there could be, by which intervals are wider: for
/// the round-off in them.
constexpr double interval_margin = 1e-13;

template <int Dim>
double margin_of(const SeepageProblem<Dim>& problem) {
  return interval_margin * (problem.all_fluxes() + problem.largest_flux());
}

template <int Dim>
double norm(const SeepageEnergy<Dim>& energy, const Slopes<Dim>& slopes) {
  return std::sqrt(energy.inner(slopes, slopes));
}

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
    for (int g = 0; g + 1 < groups; ++g) add(problem.dual(g));
  }
  // All of them together are a unit head everywhere.
  duals.push_back(std::move(rest));
  return duals;
}

/// Discharge through held faces, m3/s, of which the mixed elements say `discharge`: between the two
/// ways to compute it from the dual, and off by at most half the product of the gaps.
template <int Dim>
Interval interval(const SeepageProblem<Dim>& problem, double discharge,
                  const FieldPair<Dim>& dual) {
  const SeepageEnergy<Dim>& energy = problem.energy();
  const FieldPair<Dim>& flow = problem.flow();
  const auto at_boundary = problem.at_boundary(dual);
  const double by_heads = -energy.inner(flow.of_head, dual.of_head) - at_boundary.given;
  const double by_fluxes = discharge + at_boundary.held + energy.inner(flow.of_flux, dual.of_flux);
  const double middle = 0.5 * (by_heads + by_fluxes);
  const double half =
      0.5 * norm(energy, flow.gap()) * norm(energy, dual.gap()) + margin_of(problem);
  return {middle - half, middle + half};
}

/// A discharge through faces that hold heads, m3/s, with its dual.
template <int Dim>
struct HeldDischarge {
  double value = 0.0;
  FieldPair<Dim> dual;
};

/// Sum of what leaves through groups.
template <int Dim>
HeldDischarge<Dim> outflow_of(const SeepageProblem<Dim>& problem,
                              const std::vector<FieldPair<Dim>>& duals,
                              const std::vector<double>& discharges) {
  HeldDischarge<Dim> sum{0.0, problem.uniform(0.0)};
  for (std::size_t g = 0; g < duals.size(); ++g) {
    if (!(discharges[g] > 0.0)) continue;
    sum.value += discharges[g];
    sum.dual = problem.combined(std::move(sum.dual), 1.0, duals[g]);
  }
  return sum;
}

/// The group of which least is known.
template <int Dim>
HeldDischarge<Dim> least_known(const SeepageProblem<Dim>& problem,
                               const std::vector<FieldPair<Dim>>& duals,
                               const std::vector<double>& discharges) {
  const auto gap = [&](const FieldPair<Dim>& dual) { return norm(problem.energy(), dual.gap()); };
  const auto widest = std::ranges::max_element(duals, {}, gap);
  return {discharges[widest - duals.begin()], *widest};
}

/// Each element's part in half the product of the gaps of flow and dual.
template <int Dim>
std::vector<double> parts_of_error(const SeepageProblem<Dim>& problem, const FieldPair<Dim>& dual) {
  const SeepageEnergy<Dim>& energy = problem.energy();
  const Slopes<Dim> gap = problem.flow().gap();
  const Slopes<Dim> dual_gap = dual.gap();
  std::vector<double> parts = energy.per_element(gap, gap);
  const std::vector<double> of_dual = energy.per_element(dual_gap, dual_gap);
  const double ratio = norm(energy, gap) / norm(energy, dual_gap);
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
  const double margin = margin_of(problem);
  for (const Crossing& crossing : problem.crossings()) {
    result.boundaries.emplace_back(Interval{crossing.given - margin, crossing.given + margin});
    result.both_ways = result.both_ways || std::min(crossing.in, crossing.out) >
                                               seepage_round_off * problem.all_fluxes();
  }
  const std::vector<FieldPair<Dim>> duals = duals_of(problem);
  std::vector<double> discharges;  // of the groups, through faces that hold heads
  for (std::size_t g = 0; g < duals.size(); ++g) {
    const std::vector<int>& members = problem.groups()[g];
    double discharge = 0.0;
    double out = 0.0;
    double in = 0.0;
    for (const int b : members) {
      const double held = problem.crossings()[b].held;
      discharge += held;
      (held > 0.0 ? out : in) += std::abs(held);
      if (members.size() > 1) result.boundaries[b].reset();
    }
    if (members.size() == 1) {
      const Interval of_group = interval(problem, discharge, duals[g]);
      Interval& whole = *result.boundaries[members.front()];
      whole = {whole.low + of_group.low, whole.high + of_group.high};
    }
    result.both_ways =
        result.both_ways || std::min(in, out) > seepage_round_off * problem.all_fluxes();
    discharges.push_back(discharge);
  }
  HeldDischarge<Dim> held = outflow_of(problem, duals, discharges);
  result.flux_out = interval(problem, held.value, held.dual);
  // Known by balance, where the rest is given.
  const bool is_known = result.flux_out.half() <= seepage_round_off * problem.all_fluxes();
  result.least_known = result.flux_out;
  if (is_known && !duals.empty()) {
    held = least_known(problem, duals, discharges);
    result.least_known = interval(problem, held.value, held.dual);
  }
  result.error = parts_of_error(problem, held.dual);
  for (const Crossing& crossing : problem.crossings()) {
    result.flux_out.low += std::max(0.0, crossing.given);
    result.flux_out.high += std::max(0.0, crossing.given);
  }
  return result;
}

template DischargeBounds discharge_bounds(const SeepageState<2>&);
template DischargeBounds discharge_bounds(const SeepageState<3>&);

}  // namespace suffuse

#include "bounds/seepage_problem.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "bounds/conforming_head.hpp"
#include "grid/face_flux.hpp"
#include "grid/field_values.hpp"
#include "physics/head.hpp"

namespace suffuse {
namespace {

/// Fluxes that differ from Darcy's law by less than this share of all are those of it.
constexpr double darcy_tolerance = 1e-7;
/// Relative conductivity below which soil counts as this dry: no water to speak of flows there.
constexpr double driest_relative_conductivity = 1e-9;

}  // namespace

template <int Dim>
SeepageProblem<Dim>::SeepageProblem(const SeepageState<Dim>& state)
    : state_(state),
      grid_(state.grid),
      weight_(unit_weight(state.scene.liquid.density, state.scene.gravity)),
      energy_(grid_, conductivities(), state.soils.bedding, state.walls, weight_),
      prescribed_(grid_.mesh.node_count()),
      inflow_(grid_.face_count(), 0.0),
      group_of_face_(grid_.face_count(), -1),
      holds_in_part_(state.scene.boundaries.size(), false),
      crossings_(state.scene.boundaries.size()) {
  prescribe();
  sum_crossings();
  outflow_ = outflows();
  balances_ = largest_magnitude(outflow_) <= seepage_round_off * all_fluxes_;
  flow_ = pair(state_.face_pressure, state_.face_flux, {}, prescribed_);
  gap_ = flow_.gap();
  gap_norm_ = std::sqrt(energy_.inner(gap_, gap_));
}

template <int Dim>
std::vector<double> SeepageProblem<Dim>::conductivities() const {
  const FlowCoefficients<Dim>& c = state_.coefficients;
  std::vector<double> result;
  for (std::size_t e = 0; e < c.porosity.size(); ++e) {
    double conductivity = weight_ * c.porosity[e] / c.drag[e];
    result.push_back(conductivity * relative_conductivity(e));
  }
  return result;
}

template <int Dim>
double SeepageProblem<Dim>::relative_conductivity(std::size_t element) const {
  if (state_.relative_conductivity.empty()) return 1.0;
  return std::max(driest_relative_conductivity, state_.relative_conductivity[element]);
}

template <int Dim>
bool SeepageProblem<Dim>::holds_head(int face) const {
  const FaceCondition& condition = state_.conditions[face];
  // Water leaves an open seepage face at p = 0.
  return condition.kind == FaceKind::pressure ||
         (condition.kind == FaceKind::seepage && state_.face_pressure[face] == 0.0);
}

template <int Dim>
double SeepageProblem<Dim>::height_of(const Vector<Dim>& x) const {
  return height(x, state_.scene.gravity);
}

template <int Dim>
void SeepageProblem<Dim>::prescribe() {
  std::vector<std::vector<int>> boundaries_of_node(grid_.mesh.node_count());
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!grid_.is_border(f)) continue;
    if (!holds_head(f)) {
      inflow_[f] = -state_.face_flux[f];
      continue;
    }
    const FaceCondition& condition = state_.conditions[f];
    const bool is_level = condition.kind == FaceKind::pressure &&
                          state_.scene.boundaries[condition.boundary].head.has_value();
    const double pressure_head = state_.face_pressure[f] / weight_;
    for (const int i : grid_.face_nodes[f]) {
      const Vector<Dim> place = is_level ? grid_.face_centre(f) : grid_.mesh.nodes[i];
      const double head = pressure_head + height_of(place);
      const double jump = prescribed_[i] ? std::abs(*prescribed_[i] - head) : 0.0;
      largest_head_ = std::max(largest_head_, std::abs(head));
      largest_jump_ = std::max(largest_jump_, jump);
      prescribed_[i] = head;
      boundaries_of_node[i].push_back(condition.boundary);
    }
  }
  // Heads may all be zero.
  const double volume = std::accumulate(grid_.volume.begin(), grid_.volume.end(), 0.0);
  largest_head_ = std::max(largest_head_, std::pow(volume, 1.0 / Dim));
  join_groups(boundaries_of_node);
}

template <int Dim>
void SeepageProblem<Dim>::join_groups(const std::vector<std::vector<int>>& boundaries_of_node) {
  // The group of a boundary is the smallest number that it is connected to.
  std::vector<int> joined(crossings_.size());
  std::iota(joined.begin(), joined.end(), 0);
  std::vector<bool> holds(crossings_.size(), false);
  for (const std::vector<int>& at_node : boundaries_of_node) {
    for (const int b : at_node) {
      holds[b] = true;
      const auto [low, high] = std::minmax(joined[at_node.front()], joined[b]);
      if (low != high) std::ranges::replace(joined, int{high}, int{low});
    }
  }
  std::vector<int> group(crossings_.size(), -1);
  for (int b = 0; b < static_cast<int>(joined.size()); ++b) {
    if (!holds[b]) continue;
    const int first = joined[b];
    if (group[first] < 0) {
      group[first] = static_cast<int>(groups_.size());
      groups_.emplace_back();
    }
    group[b] = group[first];
    groups_[group[b]].push_back(b);
  }
  for (int f = 0; f < grid_.face_count(); ++f) {
    const int b = state_.conditions[f].boundary;
    if (!grid_.is_border(f) || b < 0) continue;
    if (holds_head(f)) {
      group_of_face_[f] = group[b];
    } else if (holds[b]) {
      holds_in_part_[b] = true;
    }
  }
}

template <int Dim>
void SeepageProblem<Dim>::sum_crossings() {
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!grid_.is_border(f)) continue;
    const double flux = state_.face_flux[f];
    all_fluxes_ += std::abs(flux);
    const int b = state_.conditions[f].boundary;
    if (b < 0) continue;
    (group_of_face_[f] >= 0 ? crossings_[b].held : crossings_[b].given) += flux;
    (flux > 0.0 ? crossings_[b].out : crossings_[b].in) += std::abs(flux);
    if (!state_.step.face_flux.empty()) crossings_[b].in_time += state_.step.face_flux[f];
  }
}

template <int Dim>
std::vector<double> SeepageProblem<Dim>::heads(const std::vector<double>& face_pressure) const {
  std::vector<double> result;
  result.reserve(face_pressure.size());
  for (int f = 0; f < grid_.face_count(); ++f) {
    result.push_back(face_pressure[f] / weight_ + height_of(grid_.face_centre(f)));
  }
  return result;
}

template <int Dim>
std::vector<double> SeepageProblem<Dim>::head_errors() const {
  std::vector<double> result = state_.step.face_pressure;
  for (double& error : result) error /= weight_;
  return result;
}

template <int Dim>
FieldPair<Dim> SeepageProblem<Dim>::pair(
    const std::vector<double>& face_pressure, const std::vector<double>& face_flux,
    const VectorField<Dim>& slope, const std::vector<std::optional<double>>& prescribed) const {
  FieldPair<Dim> result;
  result.face_flux = face_flux;
  result.of_flux = energy_.of_flux(face_flux);
  for (std::size_t e = 0; e < slope.size(); ++e) result.of_flux.element[e] += slope[e];
  result.node_head = conforming_head(energy_, heads(face_pressure), result.of_flux, prescribed);
  result.of_head = energy_.of_head(result.node_head);
  return result;
}

template <int Dim>
FieldPair<Dim> SeepageProblem<Dim>::combined(FieldPair<Dim> a, double factor,
                                             const FieldPair<Dim>& b) const {
  for (std::size_t i = 0; i < a.node_head.size(); ++i) a.node_head[i] += factor * b.node_head[i];
  for (std::size_t f = 0; f < a.face_flux.size(); ++f) a.face_flux[f] += factor * b.face_flux[f];
  a.of_head = sum(a.of_head, factor, b.of_head);
  a.of_flux = sum(a.of_flux, factor, b.of_flux);
  return a;
}

template <int Dim>
FieldPair<Dim> SeepageProblem<Dim>::uniform(double head) const {
  FieldPair<Dim> result;
  result.node_head.assign(grid_.mesh.node_count(), head);
  result.face_flux.assign(grid_.face_count(), 0.0);
  result.of_head = energy_.of_head(result.node_head);
  result.of_flux = energy_.of_flux(result.face_flux);
  return result;
}

template <int Dim>
FieldPair<Dim> SeepageProblem<Dim>::dual(const DualLoad<Dim>& load) {
  std::vector<FaceCondition> conditions = state_.conditions;
  std::vector<std::optional<double>> prescribed(prescribed_.size());
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!grid_.is_outer(f)) continue;
    const bool is_held = group_of_face_[f] >= 0;
    const double head = group_of_face_[f] == load.group ? 1.0 : 0.0;
    conditions[f].switches = false;
    conditions[f].kind = is_held ? FaceKind::pressure : FaceKind::wall;
    conditions[f].value = is_held ? weight_ * (head - height_of(grid_.face_centre(f))) : 0.0;
    if (!is_held) continue;
    for (const int i : grid_.face_nodes[f]) prescribed[i] = head;
  }
  FlowForcing<Dim> forcing{state_.coefficients, std::move(conditions), load.source};
  for (const Vector<Dim>& slope : load.slope) forcing.force.push_back(weight_ * slope);
  std::vector<double>& drag = forcing.coefficients.drag;
  for (std::size_t e = 0; e < drag.size(); ++e) drag[e] /= relative_conductivity(e);
  forcing.coefficients.mixture_density.assign(drag.size(), state_.scene.liquid.density);
  forcing.coefficients.quadratic_drag.clear();
  const MixedStep<Dim> steady = dual_solver().steady(forcing);
  return pair(steady.end.face_pressure, steady.face_flux, load.slope, prescribed);
}

template <int Dim>
ImplicitMixed<Dim>& SeepageProblem<Dim>::dual_solver() {
  if (!dual_solver_) {
    ImplicitSettings settings;
    settings.threads = state_.threads;
    FlowSoils<Dim> soils;
    soils.bedding = state_.soils.bedding;
    Vector<Dim> gravity;
    for (int d = 0; d < Dim; ++d) gravity[d] = state_.scene.gravity[d];
    dual_solver_ = std::make_unique<ImplicitMixed<Dim>>(grid_, settings, gravity, std::move(soils),
                                                        state_.walls);
  }
  return *dual_solver_;
}

template <int Dim>
std::optional<std::array<double, 2>> SeepageProblem<Dim>::two_heads() const {
  if (groups_.size() != 2 || !balances_) return std::nullopt;
  std::array<double, 2> low{infinity, infinity};
  std::array<double, 2> high{-infinity, -infinity};
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (std::abs(inflow_[f]) > 1e-3 * seepage_round_off * all_fluxes_) return std::nullopt;
    if (group_of_face_[f] < 0) continue;
    for (const int i : grid_.face_nodes[f]) {
      const auto k = static_cast<std::size_t>(group_of_face_[f]);
      low[k] = std::min(low[k], *prescribed_[i]);
      high[k] = std::max(high[k], *prescribed_[i]);
    }
  }
  const double uncertain = std::max(high[0] - low[0], high[1] - low[1]);
  if (uncertain > 1e-3 * seepage_round_off * std::abs(low[0] - low[1])) return std::nullopt;
  if (std::abs(low[0] - low[1]) <= seepage_round_off * largest_head_) return std::nullopt;
  return low;
}

template <int Dim>
typename SeepageProblem<Dim>::Products SeepageProblem<Dim>::products(
    const FieldPair<Dim>& dual) const {
  Products result;
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!grid_.is_border(f)) continue;
    double head = 0.0;
    double dual_head = 0.0;
    for (const int i : grid_.face_nodes[f]) {
      head += flow_.node_head[i] / Dim;
      dual_head += dual.node_head[i] / Dim;
    }
    result.given -= inflow_[f] * dual_head;
    if (group_of_face_[f] >= 0) result.held += head * dual.face_flux[f];
  }
  for (std::size_t e = 0; e < outflow_.size(); ++e) {
    for (const int i : grid_.mesh.elements[e]) {
      result.given -= outflow_[e] * dual.node_head[i] / (Dim + 1);
    }
  }
  return result;
}

template <int Dim>
std::string SeepageProblem<Dim>::objection() const {
  if (!state_.relative_conductivity.empty()) return "the soil is unsaturated";
  if (!state_.coefficients.quadratic_drag.empty()) return "the drag is Ergun's";
  const auto switches = [](const FaceCondition& c) { return c.kind == FaceKind::seepage; };
  if (std::ranges::any_of(state_.conditions, switches)) {
    return "which seepage faces are open depends on the mesh";
  }
  if (std::ranges::any_of(holds_in_part_, std::identity())) {
    return "a water level ends within a boundary, at a face of the mesh";
  }
  if (jumps()) {
    return "heads of two boundaries differ where these meet";
  }
  if (!balances_) {
    return "water is stored, as the flow is not steady or liquid.bulk_modulus is not inf";
  }
  if (!follows_conductivity()) {
    return "the flow has inertia, or fines have changed the conductivity or the density";
  }
  return "";
}

template <int Dim>
double SeepageProblem<Dim>::largest_flux() const {
  double volume = 0.0;
  double conductivity = 0.0;
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    volume += grid_.volume[e];
    conductivity = std::max(conductivity, energy_.mean_conductivity(e));
  }
  return conductivity * largest_head_ * std::pow(volume, (Dim - 2.0) / Dim);
}

template <int Dim>
bool SeepageProblem<Dim>::jumps() const {
  return largest_jump_ > seepage_round_off * largest_head_;
}

template <int Dim>
std::vector<double> SeepageProblem<Dim>::outflows() const {
  std::vector<double> result(grid_.volume.size(), 0.0);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    result[e] = outflow(grid_, e, state_.face_flux);
  }
  return result;
}

template <int Dim>
bool SeepageProblem<Dim>::follows_conductivity() const {
  const VectorField<Dim> slope = face_slopes(grid_, heads(state_.face_pressure));
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const Vector<Dim> by_heads = energy_.conduct(e, slope[e]);
    const Vector<Dim> by_fluxes = energy_.conduct(e, flow_.of_flux.element[e]);
    // An element's fluxes add up to all of them at most.
    const double area = std::pow(grid_.volume[e], (Dim - 1.0) / Dim);
    if ((by_heads - by_fluxes).norm() * area > darcy_tolerance * all_fluxes_) return false;
  }
  return true;
}

template class SeepageProblem<2>;
template class SeepageProblem<3>;

}  // namespace suffuse

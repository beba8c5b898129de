#include "bounds/probe_means.hpp"

#include <cmath>
#include <numeric>

#include "bounds/disc_mean.hpp"
#include "bounds/goal.hpp"
#include "common/errors.hpp"
#include "grid/section_line.hpp"

namespace suffuse {
namespace {

/// Radius of the disc over the size of the model, where the scene gives none.
constexpr double share_of_model = 0.02;

template <int Dim>
double default_radius(const Grid<Dim>& grid) {
  const double volume = std::accumulate(grid.volume.begin(), grid.volume.end(), 0.0);
  return share_of_model * std::pow(volume, 1.0 / Dim);
}

/// The mean of slopes.
template <int Dim>
Vector<Dim> mean_slope(const DiscMean<Dim>& disc, const VectorField<Dim>& slope) {
  Vector<Dim> sum = Vector<Dim>::Zero();
  for (const auto& [e, share, offset] : disc.shares) sum += share * slope[e];
  return sum;
}

/// Its dual is the flow from a well that gives off 1 m3/s, spread over the disc. Where the rim cuts
/// an element, a slope in addition puts the well into the disc's part of it.
template <int Dim>
void find_head(SeepageProblem<Dim>& problem, const DiscMean<Dim>& disc, ProbeMeans& means) {
  const SeepageEnergy<Dim>& energy = problem.energy();
  const Grid<Dim>& grid = energy.grid();
  const FieldPair<Dim>& flow = problem.flow();
  const std::vector<double> in_time = problem.head_errors();
  DualLoad<Dim> load;
  load.source.assign(grid.volume.size(), 0.0);
  load.slope.assign(grid.volume.size(), Vector<Dim>::Zero());
  Goal goal;
  for (const auto& [e, share, offset] : disc.shares) {
    load.source[e] = share;
    load.slope[e] = energy.resist(e, share / grid.volume[e] * offset);
    goal.of_heads += share * offset.dot(flow.of_head.element[e]);
    for (const int i : grid.mesh.elements[e]) {
      goal.of_heads += share * flow.node_head[i] / (Dim + 1);
    }
    if (in_time.empty()) continue;
    for (const int f : grid.element_face[e]) goal.in_time += share * in_time[f] / (Dim + 1);
  }
  const FieldPair<Dim> dual = problem.dual(load);
  means.head = estimate(problem, goal, dual);
  means.head_step = step_estimates(problem, goal, dual);
}

/// Its dual is the flow that a slope in the disc drives.
template <int Dim>
void find_gradient(SeepageProblem<Dim>& problem, const DiscMean<Dim>& disc, ProbeMeans& means) {
  const SeepageEnergy<Dim>& energy = problem.energy();
  const FieldPair<Dim>& flow = problem.flow();
  const Vector<Dim> mean = mean_slope(disc, flow.of_flux.element);
  if (mean.norm() == 0.0) return;
  const Vector<Dim> direction = mean.normalized();
  Goal goal;
  goal.of_heads = direction.dot(mean_slope(disc, flow.of_head.element));
  const std::vector<double> in_time = problem.head_errors();
  if (!in_time.empty()) {
    goal.in_time = direction.dot(mean_slope(disc, face_slopes(energy.grid(), in_time)));
  }
  DualLoad<Dim> load;
  load.slope.assign(energy.grid().volume.size(), Vector<Dim>::Zero());
  for (const auto& [e, share, offset] : disc.shares) {
    load.slope[e] = energy.resist(e, share / energy.grid().volume[e] * direction);
  }
  const FieldPair<Dim> dual = problem.dual(load);
  means.gradient = estimate(problem, goal, dual);
  means.gradient_step = step_estimates(problem, goal, dual);
}

}  // namespace

template <int Dim>
std::vector<std::optional<ProbeMeans>> probe_means(SeepageProblem<Dim>& problem) {
  const Grid<Dim>& grid = problem.energy().grid();
  const std::vector<OutputProbe>& probes = problem.state().scene.output.probes;
  std::vector<std::optional<ProbeMeans>> result;
  for (const OutputProbe& probe : probes) {
    result.emplace_back();
    Vector<Dim> at;
    for (int d = 0; d < Dim; ++d) at[d] = probe.at[d];
    const auto place = find_place(grid, at);
    if (!place || problem.groups().empty() || problem.jumps()) continue;
    const DiscMean<Dim> disc = disc_mean(grid, *place, probe.disc.value_or(default_radius(grid)));
    ProbeMeans means;
    means.radius = disc.radius;
    try {
      find_head(problem, disc, means);
      find_gradient(problem, disc, means);
    } catch (const NumericalError&) {
      continue;  // No boundary with a head is connected to the probe.
    }
    result.back() = means;
  }
  return result;
}

template std::vector<std::optional<ProbeMeans>> probe_means(SeepageProblem<2>&);
template std::vector<std::optional<ProbeMeans>> probe_means(SeepageProblem<3>&);

}  // namespace suffuse

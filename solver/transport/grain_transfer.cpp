#include "transport/grain_transfer.hpp"

#include <algorithm>

#include <utility>

namespace suffuse {
namespace {

/// How many times what nodes hold is passed on to their neighbours before it is compared.
constexpr int smoothing_rounds = 4;

/// Each node gives what it holds to its elements in equal parts, each element to its nodes.
template <int Dim>
std::vector<double> smoothed(const Grid<Dim>& grid, std::vector<double> at_nodes) {
  for (int round = 0; round < smoothing_rounds; ++round) {
    std::vector<double> next(at_nodes.size(), 0.0);
    for (const auto& nodes : grid.mesh.elements) {
      double sum = 0.0;
      for (const int i : nodes) {
        sum += at_nodes[i] / (grid.node_element_begin[i + 1] - grid.node_element_begin[i]);
      }
      for (const int i : nodes) next[i] += sum / (Dim + 1);
    }
    at_nodes = std::move(next);
  }
  return at_nodes;
}

}  // namespace

template <int Dim>
GrainTransfer<Dim>::GrainTransfer(const Grid<Dim>& grid, const RigidSkeleton<Dim>& skeleton,
                                  double grain_density)
    : grid_(grid), skeleton_(skeleton), grain_density_(grain_density) {}

template <int Dim>
auto GrainTransfer<Dim>::transfer(const std::vector<double>& before,
                                  const std::vector<double>& after,
                                  const std::vector<double>& porosity,
                                  const std::vector<int>& begins,
                                  const std::vector<double>& point_volume,
                                  LiquidPoints<Dim>& points, std::vector<double>& pending) const
    -> Result {
  const Mesh<Dim>& mesh = grid_.mesh;
  Result result;
  result.received.assign(mesh.region_names.size(), 0.0);
  result.eroded.assign(mesh.region_names.size(), 0.0);

  // What erodes, per element and, where it goes by the nodes, per node.
  std::vector<double> eroded(mesh.element_count(), 0.0);
  std::vector<double> at_node = std::exchange(pending, std::vector<double>(pending.size(), 0.0));
  const MaterialPoints<Dim>& solid = skeleton_.points();
  const auto stays_in_element = [&](int e) {
    const bool by_element =
        skeleton_.soil_of_element(e).erosion.mass_transfer == MassTransfer::element;
    return by_element && begins[e + 1] > begins[e];
  };
  for (int s = 0; s < solid.size(); ++s) {
    const double volume = solid.volume[s] * (after[s] - before[s]);
    if (volume == 0.0) continue;
    const int e = solid.element[s];
    eroded[e] += volume;
    result.eroded[mesh.element_region[e]] += grain_density_ * volume;
    if (stays_in_element(e)) continue;
    for (int a = 0; a <= Dim; ++a) at_node[mesh.elements[e][a]] += volume * solid.barycentric[s][a];
  }

  const auto erodes = [&](int e) { return eroded[e] > 0.0; };
  // What each point would take by itself, per volume of liquid, at the nodes of eroding elements.
  std::vector<double> gain(mesh.node_count(), 0.0);
  {
    std::vector<double> volume(mesh.node_count(), 0.0);
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (!erodes(e)) continue;
      for (const int i : mesh.elements[e]) {
        gain[i] += eroded[e] / porosity[e];
        volume[i] += grid_.volume[e];
      }
    }
    for (int i = 0; i < mesh.node_count(); ++i) {
      if (volume[i] > 0.0) gain[i] /= volume[i];
    }
  }
  const auto takes_by_nodes = [&](int e) { return erodes(e) && !stays_in_element(e); };
  const auto at_point = [&](int e, int p, const std::vector<double>& at_nodes) {
    double value = 0.0;
    for (int a = 0; a <= Dim; ++a)
      value += points.barycentric[p][a] * at_nodes[mesh.elements[e][a]];
    return value;
  };
  std::vector<double> taken(mesh.node_count(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!takes_by_nodes(e)) continue;
    for (int p = begins[e]; p < begins[e + 1]; ++p) {
      const double share = point_volume[p] * at_point(e, p, gain);
      for (int a = 0; a <= Dim; ++a) {
        taken[mesh.elements[e][a]] += share * points.barycentric[p][a];
      }
    }
  }
  // Points are too few to fill every node's surroundings evenly: compared over a few elements.
  const std::vector<double> offered_near = smoothed(grid_, at_node);
  const std::vector<double> taken_near = smoothed(grid_, taken);
  std::vector<double> factor(mesh.node_count(), 0.0);
  std::vector<double> left_over(mesh.node_count(), 0.0);
  double offered = 0.0;
  double handed_out = 0.0;
  bool some_left = false;
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (taken_near[i] > 0.0) {
      factor[i] = offered_near[i] / taken_near[i];
      offered += offered_near[i];
      handed_out += factor[i] * taken[i];
    } else if (offered_near[i] > 0.0) {
      left_over[i] = offered_near[i];
      some_left = true;
    }
  }
  // What comparing over a few elements leaves out is little; all take their part in it.
  if (handed_out > 0.0) {
    for (double& f : factor) f *= offered / handed_out;
  }
  // No eroding element near has a point: to any point that the node sees, or to wait.
  std::vector<double> per_volume(some_left ? mesh.node_count() : 0, 0.0);
  if (some_left) {
    std::vector<double> seen(mesh.node_count(), 0.0);
    for (int e = 0; e < mesh.element_count(); ++e) {
      for (int p = begins[e]; p < begins[e + 1]; ++p) {
        for (int a = 0; a <= Dim; ++a) {
          seen[mesh.elements[e][a]] += point_volume[p] * points.barycentric[p][a];
        }
      }
    }
    for (int i = 0; i < mesh.node_count(); ++i) {
      if (seen[i] > 0.0) {
        per_volume[i] = left_over[i] / seen[i];
      } else {
        pending[i] = left_over[i];
      }
    }
  }

  for (int e = 0; e < mesh.element_count(); ++e) {
    if (begins[e + 1] == begins[e] || (!erodes(e) && !some_left)) continue;
    double own = 0.0;
    if (erodes(e) && stays_in_element(e)) {
      double volume = 0.0;
      for (int p = begins[e]; p < begins[e + 1]; ++p) volume += point_volume[p];
      own = eroded[e] / volume;
    }
    double received = 0.0;
    for (int p = begins[e]; p < begins[e + 1]; ++p) {
      double share = own;
      if (takes_by_nodes(e)) share += at_point(e, p, gain) * at_point(e, p, factor);
      if (some_left) share += at_point(e, p, per_volume);
      const double mass = grain_density_ * point_volume[p] * share;
      points.fines_mass[p] += mass;
      received += mass;
    }
    result.received[mesh.element_region[e]] += received;
  }
  return result;
}

template class GrainTransfer<2>;

}  // namespace suffuse

#include "transport/grain_transfer.hpp"

#include <algorithm>
#include <utility>

namespace suffuse {
namespace {

/// Liquid volume that nodes see, weighted with their shape functions, in elements that `counts`.
template <int Dim, class Counts>
std::vector<double> seen_by_nodes(const Grid<Dim>& grid, const LiquidPoints<Dim>& points,
                                  const std::vector<int>& begins,
                                  const std::vector<double>& point_volume, const Counts& counts) {
  std::vector<double> seen(grid.mesh.node_count(), 0.0);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (!counts(e)) continue;
    for (int p = begins[e]; p < begins[e + 1]; ++p) {
      for (int a = 0; a <= Dim; ++a) {
        seen[grid.mesh.elements[e][a]] += point_volume[p] * points.barycentric[p][a];
      }
    }
  }
  return seen;
}

}  // namespace

template <int Dim>
GrainTransfer<Dim>::GrainTransfer(const Grid<Dim>& grid, const RigidSkeleton<Dim>& skeleton,
                                  double grain_density)
    : grid_(grid), skeleton_(skeleton), grain_density_(grain_density) {}

template <int Dim>
auto GrainTransfer<Dim>::transfer(const std::vector<double>& before,
                                  const std::vector<double>& after, const std::vector<int>& begins,
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
  const std::vector<double> near = seen_by_nodes(grid_, points, begins, point_volume, erodes);
  const auto misses = [&](int i) { return at_node[i] > 0.0 && near[i] <= 0.0; };
  bool some_miss = false;
  for (int i = 0; i < mesh.node_count(); ++i) some_miss = some_miss || misses(i);
  std::vector<double> anywhere;
  if (some_miss) {
    anywhere = seen_by_nodes(grid_, points, begins, point_volume, [](int) { return true; });
    for (int i = 0; i < mesh.node_count(); ++i) {
      if (misses(i) && anywhere[i] <= 0.0) pending[i] = at_node[i];
    }
  }

  // Grains per liquid volume that a node hands out, to eroding elements and to all.
  std::vector<double> to_near(mesh.node_count(), 0.0);
  std::vector<double> to_all(some_miss ? mesh.node_count() : 0, 0.0);
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (near[i] > 0.0) to_near[i] = at_node[i] / near[i];
    if (misses(i) && anywhere[i] > 0.0) to_all[i] = at_node[i] / anywhere[i];
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (begins[e + 1] == begins[e] || (!erodes(e) && !some_miss)) continue;
    double own = 0.0;
    if (erodes(e) && stays_in_element(e)) {
      double volume = 0.0;
      for (int p = begins[e]; p < begins[e + 1]; ++p) volume += point_volume[p];
      own = eroded[e] / volume;
    }
    double received = 0.0;
    for (int p = begins[e]; p < begins[e + 1]; ++p) {
      double gain = own;
      for (int a = 0; a <= Dim; ++a) {
        const int i = mesh.elements[e][a];
        if (erodes(e)) gain += points.barycentric[p][a] * to_near[i];
        if (some_miss) gain += points.barycentric[p][a] * to_all[i];
      }
      const double mass = grain_density_ * point_volume[p] * gain;
      points.fines_mass[p] += mass;
      received += mass;
    }
    result.received[mesh.element_region[e]] += received;
  }
  return result;
}

template class GrainTransfer<2>;

}  // namespace suffuse

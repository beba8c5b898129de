#include "points/fines_transfer.hpp"

#include <utility>

namespace suffuse {
namespace {

/// Rounds of averaging of values at nodes over elements before the comparison. Uptakes along paths
/// are accurate, so a wider comparison is better for them.
constexpr int rounds_at_places = 4;
constexpr int rounds_along_paths = 8;

/// Distributes node values to the elements in equal parts, and back to the nodes; keeps their sum.
template <int Dim>
std::vector<double> smoothed(const Grid<Dim>& grid, std::vector<double> at_nodes, int rounds) {
  for (int round = 0; round < rounds; ++round) {
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

/// phi_e / n_L times the step at nodes: the own uptake of points of eroding elements per volume of
/// liquid. It is the volume-weighted mean over the eroding elements around a node.
template <int Dim>
std::vector<double> gain_at_nodes(const Grid<Dim>& grid, const std::vector<double>& eroded,
                                  const std::vector<double>& porosity) {
  std::vector<double> gain(grid.mesh.node_count(), 0.0);
  std::vector<double> volume(grid.mesh.node_count(), 0.0);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (!(eroded[e] > 0.0)) continue;
    for (const int i : grid.mesh.elements[e]) {
      gain[i] += eroded[e] / porosity[e];
      volume[i] += grid.volume[e];
    }
  }
  for (std::size_t i = 0; i < gain.size(); ++i) {
    if (volume[i] > 0.0) gain[i] /= volume[i];
  }
  return gain;
}

}  // namespace

template <int Dim>
FinesTransfer<Dim>::FinesTransfer(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                  double grain_density)
    : grid_(grid), soils_(soils), grain_density_(grain_density) {}

template <int Dim>
auto FinesTransfer<Dim>::collect(const std::vector<double>& exchange,
                                 const std::function<bool(int)>& stays_in_element,
                                 std::vector<double>& pending, Result& result) const -> Eroded {
  const Mesh<Dim>& mesh = grid_.mesh;
  result.received.assign(mesh.region_names.size(), 0.0);
  result.eroded.assign(mesh.region_names.size(), 0.0);
  Eroded eroded{std::vector<double>(mesh.element_count(), 0.0),
                std::exchange(pending, std::vector<double>(pending.size(), 0.0))};
  const MaterialPoints<Dim>& solid = soils_.points();
  for (std::size_t s = 0; s < exchange.size(); ++s) {
    const double volume = exchange[s];
    if (volume == 0.0) continue;
    const int e = solid.element[s];
    eroded.in_element[e] += volume;
    result.eroded[mesh.element_region[e]] += grain_density_ * volume;
    if (stays_in_element(e)) continue;
    for (int a = 0; a <= Dim; ++a) {
      eroded.at_node[mesh.elements[e][a]] += volume * solid.barycentric[s][a];
    }
  }
  return eroded;
}

template <int Dim>
auto FinesTransfer<Dim>::compare(
    const std::vector<double>& at_node, const std::vector<double>& uptake, int rounds,
    const std::function<void(std::vector<double>& volume)>& liquid_around,
    std::vector<double>& pending) const -> Handout {
  const Mesh<Dim>& mesh = grid_.mesh;
  // Points do not fill the surroundings of each node evenly, so the comparison is smoothed.
  const std::vector<double> offered_near = smoothed(grid_, at_node, rounds);
  const std::vector<double> uptake_near = smoothed(grid_, uptake, rounds);
  Handout handout{std::vector<double>(mesh.node_count(), 0.0), {}};
  std::vector<double> left_over(mesh.node_count(), 0.0);
  double offered = 0.0;
  double handed_out = 0.0;
  bool some_left = false;
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (uptake_near[i] > 0.0) {
      handout.factor[i] = offered_near[i] / uptake_near[i];
      offered += offered_near[i];
      handed_out += handout.factor[i] * uptake[i];
    } else if (offered_near[i] > 0.0) {
      left_over[i] = offered_near[i];
      some_left = true;
    }
  }
  // The smoothed comparison leaves a small difference, which is distributed over all nodes.
  if (handed_out > 0.0) {
    for (double& f : handout.factor) f *= offered / handed_out;
  }
  if (!some_left) return handout;
  // No eroding element near has a point: fines go to any point around the node or stay pending.
  handout.per_volume.assign(mesh.node_count(), 0.0);
  std::vector<double> liquid(mesh.node_count(), 0.0);
  liquid_around(liquid);
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (liquid[i] > 0.0) {
      handout.per_volume[i] = left_over[i] / liquid[i];
    } else {
      pending[i] = left_over[i];
    }
  }
  return handout;
}

template <int Dim>
auto FinesTransfer<Dim>::transfer(const std::vector<double>& exchange,
                                  const std::vector<double>& porosity, LiquidDensities densities,
                                  PointBlocks<Dim>& liquid, std::vector<double>& pending) const
    -> Result {
  const Mesh<Dim>& mesh = grid_.mesh;
  const auto volume_of = [&](int e, int k) {
    return liquid_volume(liquid.water_mass(e, k), liquid.fines_mass(e, k), densities, 1.0);
  };
  Result result;
  const auto stays_in_element = [&](int e) { return shares_by_element(e) && liquid.count(e) > 0; };
  const auto [eroded, at_node] = collect(exchange, stays_in_element, pending, result);
  const auto erodes = [&in = eroded](int e) { return in[e] > 0.0; };
  const std::vector<double> gain = gain_at_nodes(grid_, eroded, porosity);
  const auto through_nodes = [&](int e) { return erodes(e) && !stays_in_element(e); };
  std::vector<double> uptake_at_node(mesh.node_count(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!through_nodes(e)) continue;
    for (int k = 0; k < liquid.count(e); ++k) {
      const auto at = liquid.barycentric(e, k);
      const double share = volume_of(e, k) * at_place(e, at, gain);
      for (int a = 0; a <= Dim; ++a) uptake_at_node[mesh.elements[e][a]] += share * at[a];
    }
  }
  const auto liquid_around = [&](std::vector<double>& volume) {
    for (int e = 0; e < mesh.element_count(); ++e) {
      for (int k = 0; k < liquid.count(e); ++k) {
        const auto at = liquid.barycentric(e, k);
        for (int a = 0; a <= Dim; ++a) volume[mesh.elements[e][a]] += volume_of(e, k) * at[a];
      }
    }
  };
  const Handout handout =
      compare(at_node, uptake_at_node, rounds_at_places, liquid_around, pending);
  const bool some_left = !handout.per_volume.empty();

  for (int e = 0; e < mesh.element_count(); ++e) {
    if (liquid.count(e) == 0 || (!erodes(e) && !some_left)) continue;
    double own = 0.0;
    if (erodes(e) && stays_in_element(e)) {
      double volume = 0.0;
      for (int k = 0; k < liquid.count(e); ++k) volume += volume_of(e, k);
      own = eroded[e] / volume;
    }
    double received = 0.0;
    for (int k = 0; k < liquid.count(e); ++k) {
      const auto at = liquid.barycentric(e, k);
      double share = own;
      if (through_nodes(e)) share += at_place(e, at, gain) * at_place(e, at, handout.factor);
      if (some_left) share += at_place(e, at, handout.per_volume);
      const double mass = grain_density_ * volume_of(e, k) * share;
      liquid.add_fines(e, k, mass);
      received += mass;
    }
    result.received[mesh.element_region[e]] += received;
  }
  return result;
}

template <int Dim>
auto FinesTransfer<Dim>::transfer_along_paths(const std::vector<double>& exchange,
                                              const std::vector<double>& point_volume,
                                              LiquidPoints<Dim>& points,
                                              std::vector<FinesUptake<Dim>>& uptakes,
                                              std::vector<double>& pending) const -> Result {
  const Mesh<Dim>& mesh = grid_.mesh;
  std::vector<double> uptake_in_element(mesh.element_count(), 0.0);
  for (const FinesUptake<Dim>& uptake : uptakes)
    uptake_in_element[uptake.element] += uptake.own_volume;
  const auto stays_in_element = [&](int e) {
    return shares_by_element(e) && uptake_in_element[e] > 0.0;
  };
  Result result;
  const Eroded eroded = collect(exchange, stays_in_element, pending, result);
  std::vector<double> uptake_at_node(mesh.node_count(), 0.0);
  for (const FinesUptake<Dim>& uptake : uptakes) {
    if (stays_in_element(uptake.element)) continue;
    for (int a = 0; a <= Dim; ++a) {
      uptake_at_node[mesh.elements[uptake.element][a]] += uptake.own_volume * uptake.barycentric[a];
    }
  }
  const auto liquid_around = [&](std::vector<double>& volume) {
    for (int p = 0; p < points.size(); ++p) {
      for (int a = 0; a <= Dim; ++a) {
        volume[mesh.elements[points.element[p]][a]] += point_volume[p] * points.barycentric[p][a];
      }
    }
  };
  const Handout handout =
      compare(eroded.at_node, uptake_at_node, rounds_along_paths, liquid_around, pending);

  for (FinesUptake<Dim>& uptake : uptakes) {
    const int e = uptake.element;
    const double ratio = stays_in_element(e) ? eroded.in_element[e] / uptake_in_element[e]
                                             : at_place(e, uptake.barycentric, handout.factor);
    uptake.mass = grain_density_ * uptake.own_volume * ratio;
    points.fines_mass[uptake.point] += uptake.mass;
    result.received[uptake.region] += uptake.mass;
  }
  if (handout.per_volume.empty()) return result;
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    const double mass =
        grain_density_ * point_volume[p] * at_place(e, points.barycentric[p], handout.per_volume);
    points.fines_mass[p] += mass;
    result.received[mesh.element_region[e]] += mass;
  }
  return result;
}

template class FinesTransfer<2>;
template class FinesTransfer<3>;

}  // namespace suffuse

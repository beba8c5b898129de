#include "points/fines_transfer.hpp"

#include <utility>

namespace suffuse {
namespace {

/// Rounds of averaging of values at nodes over elements before the comparison. Uptakes along paths
/// are accurate, so a wider comparison is better for them.
constexpr int rounds_at_places = 4;
constexpr int rounds_along_paths = 8;

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

/// Not inlined, so that products are rounded before they are added: on several ranks they are sent.
template <std::size_t size>
[[gnu::noinline]] std::array<double, size> times(std::array<double, size> weights, double volume) {
  for (double& weight : weights) weight *= volume;
  return weights;
}

}  // namespace

template <int Dim>
FinesTransfer<Dim>::FinesTransfer(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                  const SharedPoints<Dim>& shared, double grain_density)
    : grid_(grid), soils_(soils), shared_(shared), grain_density_(grain_density) {
  elements_at_node_.reserve(grid.mesh.nodes.size());
  for (int i = 0; i < grid.mesh.node_count(); ++i) {
    elements_at_node_.push_back(grid.node_element_begin[i + 1] - grid.node_element_begin[i]);
  }
  grid.node_rows().exchange(elements_at_node_);
}

template <int Dim>
std::vector<double> FinesTransfer<Dim>::smoothed(std::vector<double> at_nodes, int rounds) const {
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> next(at_nodes.size(), 0.0);
    for (const auto& nodes : grid_.mesh.elements) {
      double sum = 0.0;
      for (const int i : nodes) sum += at_nodes[i] / elements_at_node_[i];
      for (const int i : nodes) next[i] += sum / (Dim + 1);
    }
    grid_.node_rows().exchange(next);
    at_nodes = std::move(next);
  }
  return at_nodes;
}

template <int Dim>
template <class Give>
std::vector<double> FinesTransfer<Dim>::sums_at_nodes(const Give& give) const {
  const Mesh<Dim>& mesh = grid_.mesh;
  const auto at_corners = shared_.template sums<Dim + 1>(give);
  std::vector<double> result(mesh.node_count(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int a = 0; a <= Dim; ++a) result[mesh.elements[e][a]] += at_corners[e][a];
  }
  grid_.node_rows().exchange(result);
  return result;
}

template <int Dim>
auto FinesTransfer<Dim>::collect(const std::vector<double>& exchange,
                                 const std::function<bool(int)>& stays_in_element,
                                 std::vector<double>& pending, Result& result) const -> Eroded {
  const Mesh<Dim>& mesh = grid_.mesh;
  result.received.assign(mesh.region_names.size(), {});
  result.eroded.assign(mesh.region_names.size(), {});
  Eroded eroded{std::vector<double>(mesh.element_count(), 0.0),
                std::exchange(pending, std::vector<double>(pending.size(), 0.0))};
  const MaterialPoints<Dim>& solid = soils_.points();
  for (std::size_t s = 0; s < exchange.size(); ++s) {
    const double volume = exchange[s];
    if (volume == 0.0) continue;
    const int e = solid.element[s];
    eroded.in_element[e] += volume;
    if (grid_.element_rows().owns(e)) {
      result.eroded[mesh.element_region[e]].add(grain_density_ * volume);
    }
    if (stays_in_element(e)) continue;
    for (int a = 0; a <= Dim; ++a) {
      eroded.at_node[mesh.elements[e][a]] += volume * solid.barycentric[s][a];
    }
  }
  grid_.node_rows().exchange(eroded.at_node);
  return eroded;
}

template <int Dim>
auto FinesTransfer<Dim>::compare(const std::vector<double>& at_node,
                                 const std::vector<double>& uptake, int rounds,
                                 const std::function<std::vector<double>()>& liquid_around,
                                 std::vector<double>& pending) const -> Handout {
  const Mesh<Dim>& mesh = grid_.mesh;
  // Points do not fill the surroundings of each node evenly, so the comparison is smoothed.
  const std::vector<double> offered_near = smoothed(at_node, rounds);
  const std::vector<double> uptake_near = smoothed(uptake, rounds);
  Handout handout{std::vector<double>(mesh.node_count(), 0.0), {}};
  std::vector<double> left_over(mesh.node_count(), 0.0);
  ExactSum offered;
  ExactSum handed_out;
  bool some_left = false;
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (uptake_near[i] > 0.0) {
      handout.factor[i] = offered_near[i] / uptake_near[i];
      if (!grid_.node_rows().owns(i)) continue;
      offered.add(offered_near[i]);
      handed_out.add(handout.factor[i] * uptake[i]);
    } else if (offered_near[i] > 0.0) {
      left_over[i] = offered_near[i];
      some_left = true;
    }
  }
  // The smoothed comparison leaves a small difference, which is distributed over all nodes.
  grid_.ranks().sum({&offered, &handed_out});
  if (handed_out.value() > 0.0) {
    const double ratio = offered.value() / handed_out.value();
    for (double& f : handout.factor) f *= ratio;
  }
  if (!any_of_all(grid_.ranks(), some_left)) return handout;
  // No eroding element near has a point: fines go to any point around the node or stay pending.
  handout.per_volume.assign(mesh.node_count(), 0.0);
  const std::vector<double> liquid = liquid_around();
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
  const auto liquid_around = [&] {
    std::vector<double> volume(mesh.node_count(), 0.0);
    for (int e = 0; e < mesh.element_count(); ++e) {
      for (int k = 0; k < liquid.count(e); ++k) {
        const auto at = liquid.barycentric(e, k);
        for (int a = 0; a <= Dim; ++a) volume[mesh.elements[e][a]] += volume_of(e, k) * at[a];
      }
    }
    return volume;
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
    result.received[mesh.element_region[e]].add(received);
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
  const auto uptake_in_element = shared_.template sums<1>([&](const auto& add) {
    for (const FinesUptake<Dim>& uptake : uptakes) {
      add(uptake.element, uptake.point, {uptake.own_volume});
    }
  });
  const auto stays_in_element = [&](int e) {
    return shares_by_element(e) && uptake_in_element[e][0] > 0.0;
  };
  Result result;
  const Eroded eroded = collect(exchange, stays_in_element, pending, result);
  const std::vector<double> uptake_at_node = sums_at_nodes([&](const auto& add) {
    for (const FinesUptake<Dim>& uptake : uptakes) {
      if (stays_in_element(uptake.element)) continue;
      add(uptake.element, uptake.point, times(uptake.barycentric, uptake.own_volume));
    }
  });
  const auto liquid_around = [&] {
    return sums_at_nodes([&](const auto& add) {
      for (int p = 0; p < points.size(); ++p) {
        add(points.element[p], p, times(points.barycentric[p], point_volume[p]));
      }
    });
  };
  const Handout handout =
      compare(eroded.at_node, uptake_at_node, rounds_along_paths, liquid_around, pending);

  for (FinesUptake<Dim>& uptake : uptakes) {
    const int e = uptake.element;
    const double ratio = stays_in_element(e) ? eroded.in_element[e] / uptake_in_element[e][0]
                                             : at_place(e, uptake.barycentric, handout.factor);
    uptake.mass = grain_density_ * uptake.own_volume * ratio;
    points.fines_mass[uptake.point] += uptake.mass;
    result.received[uptake.region].add(uptake.mass);
  }
  if (handout.per_volume.empty()) return result;
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    const double mass =
        grain_density_ * point_volume[p] * at_place(e, points.barycentric[p], handout.per_volume);
    points.fines_mass[p] += mass;
    result.received[mesh.element_region[e]].add(mass);
  }
  return result;
}

template class FinesTransfer<2>;
template class FinesTransfer<3>;

}  // namespace suffuse

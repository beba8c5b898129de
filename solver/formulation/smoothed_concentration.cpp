#include "formulation/smoothed_concentration.hpp"

namespace suffuse {

template <int Dim>
std::vector<double> smoothed_concentration(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                           std::vector<double> concentration,
                                           const std::vector<double>& volume) {
  constexpr int rounds = 4;
  const auto& region = grid.mesh.element_region;
  std::vector<ExactSum> fines_sum(grid.mesh.region_names.size());
  std::vector<ExactSum> volume_sum(fines_sum.size());
  for (const int e : grid.own_elements()) {
    fines_sum[region[e]].add(volume[e] * concentration[e]);
    volume_sum[region[e]].add(volume[e]);
  }
  const std::vector<double> fines_of_region = values_of_all(grid.ranks(), std::move(fines_sum));
  const std::vector<double> volume_of_region = values_of_all(grid.ranks(), std::move(volume_sum));
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> fines(grid.mesh.node_count(), 0.0);
    std::vector<double> liquid(fines.size(), 0.0);
    for (int e = 0; e < grid.mesh.element_count(); ++e) {
      if (!soils.is_soil(e)) continue;
      for (const int i : grid.mesh.elements[e]) {
        fines[i] += volume[e] * concentration[e];
        liquid[i] += volume[e];
      }
    }
    grid.node_rows().exchange(fines);
    grid.node_rows().exchange(liquid);
    for (int e = 0; e < grid.mesh.element_count(); ++e) {
      double mean = 0.0;
      for (const int i : grid.mesh.elements[e]) {
        mean += liquid[i] > 0.0 ? fines[i] / liquid[i] / (Dim + 1) : 0.0;
      }
      concentration[e] = mean;
    }
  }
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const int r = region[e];
    if (soils.is_soil(e) || volume_of_region[r] <= 0.0) continue;
    concentration[e] = fines_of_region[r] / volume_of_region[r];
  }
  return concentration;
}

template std::vector<double> smoothed_concentration(const Grid<2>&, const SoilMap<2>&,
                                                    std::vector<double>,
                                                    const std::vector<double>&);
template std::vector<double> smoothed_concentration(const Grid<3>&, const SoilMap<3>&,
                                                    std::vector<double>,
                                                    const std::vector<double>&);

}  // namespace suffuse

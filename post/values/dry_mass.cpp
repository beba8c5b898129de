#include "values/dry_mass.hpp"

namespace suffuse {
namespace {

/// Dry mass of a soil with the porosity of the scene, which all stages have in common.
double mass_by_scene(const ResultsReader& results, const Soil& soil) {
  return with_mesh(results, [&](const auto& mesh) {
    double sum = 0.0;
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (mesh.region_names[mesh.element_region[e]] != soil.region) continue;
      const double porosity = soil.initial_porosity(element_centroid(mesh, e));
      sum += element_volume(mesh, e) * (1.0 - porosity) * soil.grain_density;
    }
    return sum;
  });
}

}  // namespace

std::vector<DryMass> dry_masses(const ResultsReader& results) {
  const Table table = results.region_ledgers();
  const std::vector<double>& region = table.column("region");
  const std::vector<double>& solid = table.column("solid");
  const std::vector<double>& time = table.column("t");
  // Results of earlier versions have no such column: their soil stayed in its region.
  const std::vector<double> carried =
      table.has("carried") ? table.column("carried") : std::vector<double>(table.rows());
  std::vector<DryMass> masses;
  for (std::size_t r = 0; r < results.regions().size(); ++r) {
    const Soil* soil = results.scene().scene.find_soil(results.regions()[r]);
    if (soil == nullptr || !soil->exchanges()) continue;
    DryMass mass{.region = soil->region};
    bool is_first = true;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (region[row] != static_cast<double>(r)) continue;
      mass.last = solid[row] - carried[row];
      mass.time = time[row];
      if (is_first) mass.start = mass.last;
      is_first = false;
    }
    if (!(mass.start > 0.0)) continue;
    const bool is_later_stage = !results.scene().scene.initial_from.empty();
    mass.initial = is_later_stage && !results.scene().scene.moves() ? mass_by_scene(results, *soil)
                                                                    : mass.start;
    masses.push_back(mass);
  }
  return masses;
}

double dry_mass_at_start(const ResultsReader& results) {
  double sum = 0.0;
  for (const DryMass& mass : dry_masses(results)) sum += mass.start;
  return sum;
}

}  // namespace suffuse

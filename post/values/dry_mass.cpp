#include "values/dry_mass.hpp"

namespace suffuse {

std::vector<DryMass> dry_masses(const ResultsReader& results) {
  const Table table = results.region_ledgers();
  const std::vector<double>& region = table.column("region");
  const std::vector<double>& solid = table.column("solid");
  const std::vector<double>& time = table.column("t");
  std::vector<DryMass> masses;
  for (std::size_t r = 0; r < results.regions().size(); ++r) {
    const Soil* soil = results.scene().scene.find_soil(results.regions()[r]);
    if (soil == nullptr || !soil->exchanges()) continue;
    DryMass mass{.region = soil->region};
    bool is_first = true;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (region[row] != static_cast<double>(r)) continue;
      mass.last = solid[row];
      mass.time = time[row];
      if (is_first) mass.start = mass.last;
      is_first = false;
    }
    if (mass.start > 0.0) masses.push_back(mass);
  }
  return masses;
}

double dry_mass_at_start(const ResultsReader& results) {
  double sum = 0.0;
  for (const DryMass& mass : dry_masses(results)) sum += mass.start;
  return sum;
}

}  // namespace suffuse

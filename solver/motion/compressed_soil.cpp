#include "motion/compressed_soil.hpp"

#include <Eigen/LU>
#include <sstream>

#include "solid/skeleton.hpp"

namespace suffuse {

template <int Dim>
void refuse_compressed(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                       const SoilStep<Dim>& step) {
  constexpr double hardly_any = 0.01;  // of the pores at the start
  const SolidPoints<Dim>& points = step.points;
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    const double before = 1.0 - step.solid_volume[p] / points.volume[p];
    const double after =
        1.0 - step.solid_volume[p] / (points.volume[p] * step.increments[e].determinant());
    // Pores closed by deposits do not count: the step does not compress them.
    if (after > hardly_any * step.initial_porosity[p] || after >= before) continue;
    const Soil& soil = soils.soil_of_point(p);
    std::ostringstream message;
    message.precision(3);
    message << "t = " << step.end << " s: soil \"" << soil.region << "\" in "
            << element_text(grid, e) << " is compressed to its grains: its porosity, "
            << step.initial_porosity[p] << " at the start and " << before
            << " a step before, falls to " << after
            << "; the law of its skeleton does not stiffen before that. Expected are loads well "
               "below its stiffness (soil."
            << soil.region << ".skeleton.young, with all fines and without)";
    throw EquilibriumLost(message.str());
  }
}

template <int Dim>
void refuse_impossible(const Grid<Dim>& grid, const std::vector<double>& solid_volume,
                       double time) {
  constexpr double round_off = 1e-9;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const double porosity = 1.0 - solid_volume[e] / grid.volume[e];
    if (porosity > 0.0 && porosity <= 1.0 + round_off) continue;
    std::ostringstream message;
    message << "t = " << time << " s: soil that moves "
            << (porosity <= 0.0 ? "is compressed to its grains"
                                : "leaves a negative volume of solid")
            << " in " << element_text(grid, e) << " (porosity " << porosity
            << "); expected are smaller elements, soil that is stiffer against its loads, or room "
               "above where it rises over the edge of the mesh (a region free_above, or one with "
               "free = true)";
    throw NumericalError(message.str());
  }
}

template void refuse_compressed(const Grid<2>&, const SoilMap<2>&, const SoilStep<2>&);
template void refuse_compressed(const Grid<3>&, const SoilMap<3>&, const SoilStep<3>&);
template void refuse_impossible(const Grid<2>&, const std::vector<double>&, double);
template void refuse_impossible(const Grid<3>&, const std::vector<double>&, double);

}  // namespace suffuse

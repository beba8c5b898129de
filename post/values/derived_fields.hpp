#pragma once

/// Fields of a snapshot: those that the solver stored, and those that follow from them.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Names of all fields of the snapshot `index` on `where`: "cell", "node", "element_vertex",
/// "solid" or "liquid". In addition to those stored:
/// - "head", m, of cells at their centroids and of nodes: h = p / (rho_w g) + z, above the datum of
///   the scene; without gravity p / (rho_w 9.81 m/s2)
/// - "conductivity" of cells, m/s: that along bedding of soil filled with clean water
/// - "saturation" of cells, where every soil is saturated: 1
/// - "fines_content" of cells and solid points: erodible share of the dry mass, n_e / (1 - n)
/// - "fines_left" of cells and solid points of rigid soil: the erodible fines over those before the
///   first stage; not a number where there were none
/// - "water_fraction" at the vertices of elements: n S - n_f
/// - "safety" of cells, against heave: see `critical_gradient` and `upward_gradient`
std::vector<std::string> all_field_names(const ResultsReader& results, std::size_t index,
                                         const std::string& where);

/// Any of these fields. Throws FileError when there is no such field.
Field any_field(const ResultsReader& results, std::size_t index, const std::string& where,
                const std::string& name);

/// The hydraulic gradient at which water that rises lifts the soil (Terzaghi), per cell:
/// i_cr = (1 - n) (rho_s / rho_w - 1). Not a number in free water.
std::vector<double> critical_gradient(const ResultsReader& results, std::size_t index);

/// k of each cell over that of this soil, whose conductivity may be a random field.
std::vector<double> conductivity_factor(const ResultsReader& results, const Soil& soil);

/// The component of the hydraulic gradient against gravity, without gravity along `upward`, per
/// cell; 0 where the soil is not saturated. The safety is the critical gradient over it, infinite
/// where it is not positive.
std::vector<double> upward_gradient(const ResultsReader& results, std::size_t index);

/// The direction against gravity; without gravity y, in three dimensions z.
template <int Dim>
Vector<Dim> upward(const Scene& scene);

}  // namespace suffuse

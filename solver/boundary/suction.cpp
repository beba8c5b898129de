#include "boundary/suction.hpp"

#include <sstream>

#include "common/errors.hpp"
#include "common/short_number.hpp"
#include "physics/head.hpp"

namespace suffuse {
namespace {

/// A smaller suction is not worth a warning, Pa.
constexpr double noticed = -5000.0;
/// Soil that conducts less than this share of what it does when saturated gives no water.
constexpr double driest = 1e-15;

}  // namespace

template <int Dim>
std::string suction_warning(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                            const PressuresAt& now) {
  const std::vector<double>& p = now.pressure;
  int lowest = -1;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (p[e] >= noticed || !soils.is_soil(e) || soils.soil_of_element(e).drains()) continue;
    if (lowest < 0 || p[e] < p[lowest]) lowest = e;
  }
  const double here = lowest < 0 ? 0.0 : p[lowest];
  const double least = smallest_of_all(grid.ranks(), here);
  if (least == 0.0) return "";
  std::ostringstream text;
  text.precision(3);
  if (here == least) {
    const std::string& region = soils.soil_of_element(lowest).region;
    text << "soil \"" << region << "\" is full of water under suction: " << here << " Pa in "
         << element_text(grid, lowest) << " at t = " << now.time
         << " s; real soil drains and conducts less: give it a [soil." << region << ".retention]";
  }
  return grid.ranks().first_text(text.str());
}

template <int Dim>
void refuse_dry_outflow(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                        const std::vector<FaceCondition>& conditions, const PressuresAt& now) {
  const Scene& scene = soils.scene();
  together(grid.ranks(), [&] {
    for (int f = 0; f < grid.face_count(); ++f) {
      const FaceCondition& condition = conditions[f];
      const bool takes =
          (condition.kind == FaceKind::flux || condition.kind == FaceKind::velocity) &&
          condition.value < 0.0;
      if (!takes) continue;
      const int e = grid.face_left[f];
      const Soil& soil = soils.soil_of_element(e);
      if (!soil.drains()) continue;
      const double psi = now.pressure[e] / unit_weight(scene.liquid.density, {});
      if (soil.retention.at(psi).relative_conductivity > driest) continue;
      throw NumericalError("boundary \"" + scene.boundaries[condition.boundary].on +
                           "\" takes water that the soil does not give: it has dried in " +
                           element_text(grid, e) + " at t = " + short_number(now.time) +
                           " s; expected is a smaller flux, a head, or a seepage face");
    }
  });
}

template std::string suction_warning(const Grid<2>&, const SoilMap<2>&, const PressuresAt&);
template std::string suction_warning(const Grid<3>&, const SoilMap<3>&, const PressuresAt&);
template void refuse_dry_outflow(const Grid<2>&, const SoilMap<2>&,
                                 const std::vector<FaceCondition>&, const PressuresAt&);
template void refuse_dry_outflow(const Grid<3>&, const SoilMap<3>&,
                                 const std::vector<FaceCondition>&, const PressuresAt&);

}  // namespace suffuse

#include "formulation/point_checks.hpp"

#include <algorithm>
#include <string>

#include "common/errors.hpp"
#include "mesh/place_text.hpp"
#include "solid/pores.hpp"

namespace suffuse {

template <int Dim>
void refuse_points_near_corners(const Case<Dim>& c, const Grid<Dim>& grid,
                                const SoilMap<Dim>& soils) {
  if (c.document.scene.formulation != Formulation::single_point) return;
  const MaterialPoints<Dim>& points = soils.points();
  const ElementField<Dim> pores = initial_pore_volume(grid, soils);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const ErosionModel& model = soils.erosion_of_element(e);
    const DepositionModel& deposition = soils.exchange_of_element(e).deposition;
    const bool fills = deposition.deposits() && deposition.has_room_limit();
    if (!erodes(model) && !fills) continue;
    ElementValues<Dim> least = pores[e];
    ElementValues<Dim> filled = pores[e];
    for (int p = soils.points_begin(e); p < soils.points_begin(e + 1); ++p) {
      const double porosity = soils.initial_porosity(p);
      const double erodible =
          erodes(model) ? points.volume[p] * (model.porosity_max - porosity) : 0.0;
      const double room = fills ? points.volume[p] * (porosity - deposition.porosity_min) : 0.0;
      for (int j = 0; j <= Dim; ++j) {
        const double basis = FieldNodes<Dim>::basis(points.barycentric[p][j]);
        least[j] += erodible * std::min(0.0, basis);
        filled[j] -= room * basis;
      }
    }
    if (std::min(*std::ranges::min_element(least), *std::ranges::min_element(filled)) > 0.0) {
      continue;
    }
    const std::string found = "solid points so near the corners of element " + std::to_string(e) +
                              " at " + place_text<Dim>(element_centroid(grid.mesh, e)) +
                              " that what they erode or catch leaves no pores elsewhere in it";
    throw InputError(
        InputProblem{c.document.locate("points.jitter"), "points", found,
                     "points nearer to their Gauss positions, with less jitter, or more of them"});
  }
}

template void refuse_points_near_corners(const Case<2>&, const Grid<2>&, const SoilMap<2>&);
template void refuse_points_near_corners(const Case<3>&, const Grid<3>&, const SoilMap<3>&);

}  // namespace suffuse

#include "mixed/flow_soils.hpp"

#include <algorithm>
#include <cmath>

#include "physics/drag.hpp"

namespace suffuse {
namespace {

constexpr double drying_suction = 1000.0;  // m

/// K / k_along = I + (k_across / k_along - 1) n n^T with the unit vector n across the bedding.
template <int Dim>
DirectionalFactor<Dim> bedding_factor(const Soil& soil) {
  const double excess = soil.anisotropy() - 1.0;
  return {across_bedding<Dim>(soil) * std::sqrt(std::abs(excess)), excess < 0.0 ? -1.0 : 1.0};
}

}  // namespace

template <int Dim>
FlowSoils<Dim> flow_soils(const Scene& scene, const Skeleton<Dim>& solid,
                          const std::vector<double>& porosity) {
  const SoilMap<Dim>& soils = solid.soils();
  FlowSoils<Dim> result;
  result.head_per_pressure = 1.0 / (scene.liquid.density * conductivity_gravity);
  const bool retains = std::ranges::any_of(scene.soils, &Soil::drains);
  const bool layered =
      std::ranges::any_of(scene.soils, [](const Soil& soil) { return soil.anisotropy() != 1.0; });
  for (int e = 0; e < soils.mesh().element_count(); ++e) {
    const Soil& soil = soils.soil_of_element(e);
    const bool left = solid.moves() && soils.points_begin(e) == soils.points_begin(e + 1);
    if (retains) {
      result.retention.push_back((left ? soils.free_space() : soil).retention);
      if (solid.moves()) result.retention.back().dries_at = drying_suction;
    }
    if (layered) result.bedding.push_back(bedding_factor<Dim>(soil));
  }
  if (retains) result.free_space = soils.free_space().retention;
  if (!retains || !solid.moves()) return result;
  const std::vector<double> without_solid = solid.element_porosity();
  for (int e = 0; e < soils.mesh().element_count(); ++e) {
    const SoilFilling& f = solid.filling()[e];
    // A gap before soil that has sunk is neither soil nor free space.
    const double gap = porosity.empty() ? 0.0 : std::max(0.0, without_solid[e] - porosity[e]);
    const double space = std::max(0.0, 1.0 - f.share - gap);
    const double share = space == 0.0 ? 1.0 : 1.0 - space / (f.share * f.porosity + space);
    result.soil_share.push_back(soils.is_soil(e) ? share : 0.0);
  }
  return result;
}

template FlowSoils<2> flow_soils(const Scene&, const Skeleton<2>&, const std::vector<double>&);
template FlowSoils<3> flow_soils(const Scene&, const Skeleton<3>&, const std::vector<double>&);

}  // namespace suffuse

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
FlowSoils<Dim> flow_soils(const Scene& scene, const SoilMap<Dim>& soils,
                          const std::vector<SoilFilling>& filling) {
  FlowSoils<Dim> result;
  result.head_per_pressure = 1.0 / (scene.liquid.density * conductivity_gravity);
  const bool retains = std::ranges::any_of(scene.soils, &Soil::drains);
  const bool layered =
      std::ranges::any_of(scene.soils, [](const Soil& soil) { return soil.anisotropy() != 1.0; });
  const bool moves = scene.moves();
  for (int e = 0; e < soils.mesh().element_count(); ++e) {
    const Soil& soil = soils.soil_of_element(e);
    const bool left = moves && soils.points_begin(e) == soils.points_begin(e + 1);
    if (retains) {
      result.retention.push_back((left ? soils.free_space() : soil).retention);
      if (moves) result.retention.back().dries_at = drying_suction;
    }
    if (layered) result.bedding.push_back(bedding_factor<Dim>(soil));
  }
  if (!retains) return result;
  result.free_space = soils.free_space().retention;
  if (!moves) return result;
  for (int e = 0; e < soils.mesh().element_count(); ++e) {
    const SoilFilling f = filling.empty() ? SoilFilling{} : filling[e];
    const double of_soil = f.share * f.porosity;
    const double share = f.share == 1.0 ? 1.0 : of_soil / (of_soil + (1.0 - f.share));
    result.soil_share.push_back(soils.is_soil(e) ? share : 0.0);
  }
  return result;
}

template FlowSoils<2> flow_soils(const Scene&, const SoilMap<2>&, const std::vector<SoilFilling>&);
template FlowSoils<3> flow_soils(const Scene&, const SoilMap<3>&, const std::vector<SoilFilling>&);

}  // namespace suffuse

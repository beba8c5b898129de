#include "flow/flow_soils.hpp"

#include <algorithm>
#include <cmath>

#include "physics/drag.hpp"

namespace suffuse {

template <int Dim>
FlowSoils<Dim> flow_soils(const Scene& scene, const SoilMap<Dim>& soils) {
  FlowSoils<Dim> result;
  result.head_per_pressure = 1.0 / (scene.liquid.density * conductivity_gravity);
  const bool retains = std::ranges::any_of(scene.soils, &Soil::drains);
  const bool layered =
      std::ranges::any_of(scene.soils, [](const Soil& soil) { return soil.anisotropy() != 1.0; });
  for (int e = 0; e < soils.mesh().element_count(); ++e) {
    const Soil& soil = soils.soil_of_element(e);
    if (retains) result.retention.push_back(soil.retention);
    if (layered) {
      result.bedding.push_back(across_bedding<Dim>(soil) * std::sqrt(1.0 - soil.anisotropy()));
    }
  }
  return result;
}

template FlowSoils<2> flow_soils(const Scene&, const SoilMap<2>&);
template FlowSoils<3> flow_soils(const Scene&, const SoilMap<3>&);

}  // namespace suffuse

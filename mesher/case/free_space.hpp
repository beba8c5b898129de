#pragma once

/// What fills the regions that have no soil.

#include <string>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Whether the region holds air where no water stands: it does where some soil has a retention law.
bool can_hold_air(const Scene& scene, const std::string& region);

/// "free water", "air", or both where the water level at the start lies within the region or is
/// not known; empty for soil. \param region  index into `region_names`
template <int Dim>
std::string free_space_text(const Mesh<Dim>& mesh, const Scene& scene, int region);

}  // namespace suffuse

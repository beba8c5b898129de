#pragma once

/// The content of regions without soil.

#include <string>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Whether the region can hold air above the water: it can if some soil has a retention law.
bool can_hold_air(const Scene& scene, const std::string& region);

/// "free water", "air", or both if the initial water level is within the region or unknown; empty
/// for soil. `region`: index into `region_names`.
template <int Dim>
std::string free_space_text(const Mesh<Dim>& mesh, const Scene& scene, int region);

}  // namespace suffuse

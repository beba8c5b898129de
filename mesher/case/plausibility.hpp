#pragma once

/// Warnings of scenes that are allowed but probably wrong: numbers in another unit, gravity
/// upwards, a mesh that is too coarse. Each warning is one sentence with place, key, value and
/// usual values.

#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Warnings of unusual lengths, densities and conductivities, gravity that points upwards, regions
/// of soil with fewer than four elements from where water enters to where it leaves, and what
/// `plausibility_base.hpp` lists.
template <int Dim>
std::vector<std::string> plausibility_warnings(const SceneDocument& document,
                                               const Mesh<Dim>& mesh);

/// A warning for each soil without a retention law that the initial water level or prescribed heads
/// and pressures put under a suction of more than 0.5 m of water somewhere. Only with gravity. The
/// solver also checks suction.
template <int Dim>
std::vector<std::string> suction_warnings(const SceneDocument& document, const Mesh<Dim>& mesh);

}  // namespace suffuse

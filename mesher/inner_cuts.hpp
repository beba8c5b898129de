#pragma once

/// Walls and wells of a scene, cut into the mesh.

#include <string>
#include <vector>

#include "case/consistency.hpp"
#include "mesh_extraction.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Cuts the mesh along each inner curve that a wall or a well names, and at each point that a well
/// names: along the two edges there that are closest to a straight line. Adds problems, and a note
/// for each inner curve that nothing names. Returns the names of all curves and points.
template <int Dim>
InnerNames cut_walls_and_wells(const SceneDocument& document, ExtractedMesh<Dim>& extracted,
                               std::vector<std::string>& notes);

}  // namespace suffuse

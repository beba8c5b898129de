#pragma once

/// Defaults of a scene that depend on its other keys.

#include <functional>
#include <string>

#include "scene/scene.hpp"

namespace suffuse {

/// \param path  of the scene's file
/// \param given  whether a key was given, right or wrong
void complete_scene(Scene& scene, const std::string& path,
                    const std::function<bool(const std::string& key)>& given);

/// The size of elements of a scene without `mesh.size`, m: it makes about 20 000 of them.
/// \param volume  m3, in two dimensions m2
/// \param from_file  of a geometry file, whose crossed mesh has other elements than a column's
double default_element_size(double volume, int dimension, MeshStructure structure, bool from_file);

/// What the summary says of such a size, and whether it is where meshing again begins: scripts look
/// for these words.
std::string default_size_note(const SceneDocument& document, double size);

}  // namespace suffuse

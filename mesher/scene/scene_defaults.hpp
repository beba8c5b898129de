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

}  // namespace suffuse

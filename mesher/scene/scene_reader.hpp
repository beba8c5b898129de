#pragma once

/// Reads the text of a scene; checks every key by itself and against the others.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace suffuse {

/// The text of a file that a scene names, or nothing if it cannot be read.
using FileLoader = std::function<std::optional<std::string>(const std::string& name)>;

/// Throws InputError with every problem found.
SceneDocument read_document(const std::string& text, const std::string& path,
                            const std::vector<std::string>& overrides, const FileLoader& load);

}  // namespace suffuse

#pragma once

/// Differences between the texts of two scenes, for messages.

#include <map>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace suffuse {

/// Every key that the scene gives, `--set` applied, with its value as messages show it. Throws
/// InputError if the text is not TOML.
std::map<std::string, std::string> written_values(const SceneDocument& document);

/// One line for each key whose value differs, `--set` applied, and for each file of values with
/// another text: `time.end: 200 there, 100 here`. Comments, spaces and the order of keys do not
/// count. Only `text`, `overrides` and `files` of the documents are compared. Empty without
/// differences.
std::vector<std::string> scene_differences(const SceneDocument& there, const SceneDocument& here);

}  // namespace suffuse

#pragma once

/// Checks the keys of a scene against each other, once each key is right by itself.

#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace suffuse {

/// Keys that do not go together, or one that another asks for.
struct Contradiction {
  std::string key;  ///< the one to change
  std::string found;
  std::string expected;
  std::vector<std::string> others;  ///< the other keys involved
};

/// What the checks may ask about a scene, and how they say what is wrong.
struct SceneInquiry {
  /// Whether a key or table was given, right or wrong.
  std::function<bool(const std::string& key)> given;
  /// Whether a key was given a value that is not allowed.
  std::function<bool(const std::string& key)> refused;
  std::function<void(const Contradiction&)> report;
};

/// Values that were wrong by themselves are still unset in `scene` and raise nothing here.
void check_scene(const Scene& scene, const SceneInquiry& inquiry);

}  // namespace suffuse

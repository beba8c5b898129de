#pragma once

/// Checks across the keys of a scene, once each key is right by itself.

#include <functional>
#include <string>

#include "case/scene.hpp"

namespace suffuse {

/// What the checks may ask about a scene, and how they say what is wrong.
struct SceneInquiry {
  /// Whether a key or table was given, right or wrong.
  std::function<bool(const std::string& key)> given;
  std::function<void(const std::string& key, const std::string& found, const std::string& expected)>
      report;
};

/// Values that were wrong by themselves are still unset in `scene` and raise nothing here.
void check_scene(const Scene& scene, const SceneInquiry& inquiry);

}  // namespace suffuse

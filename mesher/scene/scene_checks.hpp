#pragma once

/// Checks the keys of a scene against each other, after the check of each key.

#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace suffuse {

/// Keys that contradict each other, or a missing key that another one requires.
struct Contradiction {
  std::string key;  ///< the key to change
  std::string found;
  std::string expected;
  std::vector<std::string> others;  ///< the other keys involved
};

/// Questions of the checks about a scene, and their way to report problems.
struct SceneInquiry {
  /// Whether a key or table was given, right or wrong.
  std::function<bool(const std::string& key)> given;
  /// Whether a key that was given is another soil's (`like`): such a key may be unused.
  std::function<bool(const std::string& key)> inherited;
  /// Whether a key has a value that is not allowed.
  std::function<bool(const std::string& key)> refused;
  std::function<void(const Contradiction&)> report;
};

/// Values that are wrong by themselves are unset in `scene` and are not reported here.
void check_scene(const Scene& scene, const SceneInquiry& inquiry);

}  // namespace suffuse

#pragma once

/// Base of the classes that check the keys of a scene against each other.

#include <string>
#include <vector>

#include "scene/scene_checks.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {

class SceneCheckBase {
 public:
  SceneCheckBase(const Scene& scene, const SceneInquiry& inquiry)
      : scene_(scene), inquiry_(inquiry) {}

 protected:
  [[nodiscard]] bool given(const std::string& key) const { return inquiry_.given(key); }
  /// Whether a key was given in its own table.
  [[nodiscard]] bool own(const std::string& key) const {
    return given(key) && !inquiry_.inherited(key);
  }
  [[nodiscard]] bool refused(const std::string& key) const { return inquiry_.refused(key); }
  void report(const std::string& key, const std::string& found, const std::string& expected,
              const std::vector<std::string>& others = {}) const {
    inquiry_.report({.key = key, .found = found, .expected = expected, .others = others});
  }
  /// Reports `key` as missing, with the values that it may have and the other key that needs it.
  void require(const std::string& key, const std::string& pattern, const std::string& why,
               const std::string& other) const {
    if (given(key)) return;
    report(key, "nothing", find_scene_key(pattern)->expected() + ", " + why, {other});
  }
  [[nodiscard]] static std::string table_of(const Soil& soil) {
    return joined("soil", shown_name(soil.region));
  }

  [[nodiscard]] static std::vector<std::string> keys_of(const std::string& table) {
    std::vector<std::string> keys = scene_children(table);
    for (std::string& key : keys) key = joined(table, key);
    return keys;
  }

  const Scene& scene_;
  const SceneInquiry& inquiry_;
};

}  // namespace suffuse

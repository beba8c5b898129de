#pragma once

/// Common base of the checks for the warnings of `plausibility.hpp`, and the functions that make
/// these warnings.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"
#include "physics/head.hpp"
#include "scene/scene.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {

template <int Dim>
class PlausibilityBase {
 public:
  PlausibilityBase(const SceneDocument& document, const Mesh<Dim>& mesh)
      : document_(document), scene_(document.scene), mesh_(mesh) {}

 protected:
  void warn(const std::string& key, const std::string& sentence) {
    const std::string where = document_.locate(key);
    warnings_.push_back((where.empty() ? "" : where + ": ") + key + ": " + sentence);
  }

  [[nodiscard]] bool given(const std::string& key) const { return document_.where.contains(key); }

  [[nodiscard]] static std::string table_of(const Soil& soil) {
    return joined("soil", shown_name(soil.region));
  }

  [[nodiscard]] double z(int node) const { return height(mesh_.nodes[node], scene_.gravity); }

  [[nodiscard]] double as_head(double pressure) const {
    return pressure / unit_weight(scene_.liquid.density, scene_.gravity);
  }

  /// Heights of the lowest and the highest node, m; without gravity along the last axis.
  [[nodiscard]] std::pair<double, double> heights() const {
    const bool falls = has_gravity(scene_.gravity);
    std::pair<double, double> range{0.0, 0.0};
    for (int i = 0; i < mesh_.node_count(); ++i) {
      const double at = falls ? z(i) : mesh_.nodes[i][Dim - 1];
      range.first = i == 0 ? at : std::min(range.first, at);
      range.second = i == 0 ? at : std::max(range.second, at);
    }
    return range;
  }

  [[nodiscard]] bool has_free_water() const {
    return std::ranges::any_of(mesh_.region_names, [this](const std::string& region) {
      return scene_.is_free_water(region);
    });
  }

  /// The upward part of the unit normal of a face that leans by 5 degrees.
  static constexpr double nearly_upright = 0.087;

  [[nodiscard]] double height_of_model() const {
    const auto [low, high] = heights();
    return high - low;
  }

  const SceneDocument& document_;
  const Scene& scene_;
  const Mesh<Dim>& mesh_;
  std::vector<std::string> warnings_;
};

/// Warnings of tables in another unit of time, and of snapshots that fill the disk.
template <int Dim>
std::vector<std::string> time_warnings(const SceneDocument& document, const Mesh<Dim>& mesh);

/// Warnings of heads, pressures and rain in another unit, and of gravity that is missing or points
/// sideways.
template <int Dim>
std::vector<std::string> flow_warnings(const SceneDocument& document, const Mesh<Dim>& mesh);

/// Warnings of grains, strengths and loads in another unit, and of loads that act from the start.
template <int Dim>
std::vector<std::string> soil_warnings(const SceneDocument& document, const Mesh<Dim>& mesh);

/// Warnings of water that does not press on soil that moves.
template <int Dim>
std::vector<std::string> load_warnings(const SceneDocument& document, const Mesh<Dim>& mesh);

/// Warnings of keys that have no effect in this scene.
template <int Dim>
std::vector<std::string> idle_key_warnings(const SceneDocument& document, const Mesh<Dim>& mesh);

}  // namespace suffuse

#include "scene/scene_defaults.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "scene/soil_grading.hpp"

namespace suffuse {
namespace {

/// The common level of all boundaries with a head at the start, within round-off. Wells are left
/// out, because they may be pumped from the start.
std::optional<double> common_head(const Scene& scene) {
  constexpr double round_off = 1e-9;  // m
  std::optional<double> common;
  for (const BoundaryCondition& boundary : scene.boundaries) {
    if (!boundary.head || boundary.key.starts_with("well")) continue;
    const double head = boundary.head->value(0.0);
    if (common && std::abs(head - *common) > round_off) return std::nullopt;
    if (!common) common = head;
  }
  return common;
}

}  // namespace

void complete_scene(Scene& scene, const std::string& path,
                    const std::function<bool(const std::string& key)>& given) {
  const bool drains = std::ranges::any_of(scene.soils, &Soil::drains);
  if (!given("time.stepping") && drains) scene.time.stepping = TimeStepping::monotone;
  if (!given("name")) scene.name = std::filesystem::path(path).stem().string();
  if (!given("output.snapshot_every")) scene.output.snapshot_every = scene.output.every;
  if (!given("points.equal_volume") && scene.points.seeding == Seeding::gauss) {
    scene.points.equal_volume = false;
  }
  if (!given("initial.water_level")) scene.water_level = common_head(scene);
  derive_skeletons(scene, given);
}

void complete_for_mesh(SceneDocument& document, int dimension) {
  if (dimension == 2 || document.where.contains("points.solid_per_element")) return;
  document.scene.points.solid_per_element = 4;
}

}  // namespace suffuse

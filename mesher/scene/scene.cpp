#include "scene/scene.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "common/errors.hpp"
#include "scene/scene_reader.hpp"

namespace suffuse {
namespace {

/// Bytes. The limit is for devices and pipes without an end.
constexpr std::size_t largest_scene = 100'000'000;

/// Throws FileError.
std::string read_text(const std::string& path, const std::string& what) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw FileError("cannot read " + what + path);
  }
  std::string text;
  std::vector<char> block(1U << 16U);
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > largest_scene) {
      throw FileError(path + ": is larger than 100 MB; is it a scene?");
    }
  }
  if (file.bad()) throw FileError("cannot read " + what + path);
  return text;
}

}  // namespace

bool names_free_water(const std::string& region) {
  static const std::set<std::string> names{"inflow", "outflow", "free_above", "free_below"};
  return names.contains(region);
}

bool Scene::is_free_water(const std::string& region) const {
  const bool may_be_free = formulation == Formulation::double_point || moves();
  return may_be_free && (names_free_water(region) || free_regions.contains(region)) &&
         find_soil(region) == nullptr;
}

bool Scene::moves() const {
  return std::ranges::any_of(soils, [](const Soil& soil) { return soil.skeleton.moves(); });
}

bool Scene::follows_failure(const std::vector<std::string>& regions) const {
  if (time.failure != AtFailure::by_room) return time.failure == AtFailure::follow;
  return formulation == Formulation::single_point &&
         std::ranges::any_of(regions,
                             [&](const std::string& region) { return is_free_water(region); });
}

const Soil* Scene::find_soil(const std::string& region) const {
  const auto found = std::ranges::find(soils, region, &Soil::region);
  return found == soils.end() ? nullptr : &*found;
}

std::vector<std::string> Scene::names_of_slits() const {
  std::vector<std::string> names;
  for (const Wall& wall : walls) names.push_back(wall.on);
  for (const BoundaryCondition& boundary : boundaries) {
    if (boundary.is_well()) names.push_back(boundary.on);
  }
  return names;
}

std::string file_beside_scene(const std::string& scene, const std::string& name) {
  return (std::filesystem::path(scene).parent_path() / name).string();
}

std::string SceneDocument::locate(const std::string& key) const {
  std::string nearest = key;
  while (!nearest.empty()) {
    if (const auto found = where.find(nearest); found != where.end()) return found->second;
    const std::size_t end = nearest.find_last_of(".[");
    nearest.resize(end == std::string::npos ? 0 : end);
  }
  return path;
}

SceneDocument parse_scene(const std::string& text, const std::string& path,
                          const std::vector<std::string>& overrides,
                          const std::map<std::string, std::string>& files) {
  return read_document(text, path, overrides,
                       [&](const std::string& name) -> std::optional<std::string> {
                         const auto found = files.find(name);
                         return found == files.end() ? std::nullopt : std::optional(found->second);
                       });
}

SceneDocument read_scene(const std::string& path, const std::vector<std::string>& overrides) {
  const std::string text = read_text(path, "the scene ");
  SceneDocument document = read_document(
      text, path, overrides, [&](const std::string& name) -> std::optional<std::string> {
        try {
          return read_text(file_beside_scene(path, name), "");
        } catch (const FileError&) {
          return std::nullopt;
        }
      });
  document.folder = std::filesystem::absolute(path).parent_path().string();
  return document;
}

}  // namespace suffuse

#include "scene/scene_defaults.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "common/short_number.hpp"
#include "scene/soil_grading.hpp"

namespace suffuse {
namespace {

/// The common level of all boundaries with a head at the start, within round-off. Wells are left
/// out, because they may be pumped from the start.
std::optional<double> common_head(const Scene& scene) {
  constexpr double round_off = 1e-9;  // m
  std::optional<double> common;
  for (const BoundaryCondition& boundary : scene.boundaries) {
    if (!boundary.head || boundary.is_well()) continue;
    const double head = boundary.head->value(0.0);
    if (common && std::abs(head - *common) > round_off) return std::nullopt;
    if (!common) common = head;
  }
  return common;
}

/// Number of elements of size h in an area of h^2 or a volume of h^3; free ones as Gmsh makes them.
double elements_per_volume(int dimension, MeshStructure structure, bool from_file) {
  const double triangles = 4.0 / std::sqrt(3.0);
  constexpr double tetrahedra = 5.0;
  if (dimension == 3) return structure == MeshStructure::free ? tetrahedra : 6.0;
  switch (structure) {
    case MeshStructure::regular:
      return 2.0;
    case MeshStructure::crossed:
      // Twelve in a triangle of twice the size; four in a square.
      return from_file ? 3.0 * triangles : 4.0;
    case MeshStructure::free:
      break;
  }
  return triangles;
}

/// The size of elements in a built-in geometry, never larger than its smallest side.
double default_size_of_shape(const Scene& scene) {
  const GeometrySettings& geometry = scene.geometry;
  const double area = geometry.width * geometry.height;
  const double smallest = std::min(geometry.width, geometry.height);
  const MeshStructure structure = scene.mesh.structure;
  if (!geometry.is_box())
    return std::min(smallest, default_element_size(area, 2, structure, false));
  return std::min(
      {smallest, geometry.depth, default_element_size(area * geometry.depth, 3, structure, false)});
}

/// Whether studies take mesh.error = 0.01 for the scene, which gives neither that nor mesh.size. A
/// run that starts from another one needs its mesh.
bool counts_with_an_error(const SceneDocument& document) {
  const auto given = [&](const std::string& key) { return document.where.contains(key); };
  const Scene& scene = document.scene;
  const bool is_pattern =
      given("mesh.structure") && scene.mesh.structure != MeshStructure::free &&
      !(given("geometry.file") && scene.mesh.structure == MeshStructure::crossed);
  return !given("mesh.error") && !given("initial.from") && !is_pattern &&
         scene.time.scheme == FlowScheme::implicit_mixed;
}

}  // namespace

void complete_scene(Scene& scene, const std::string& path,
                    const std::function<bool(const std::string& key)>& given) {
  const bool drains = std::ranges::any_of(scene.soils, &Soil::drains);
  if (!given("time.stepping") && drains) scene.time.stepping = TimeStepping::monotone;
  // Where air moves with the soil, it takes up what water expands by as it flows to lower
  // pressures: over a long flood that was more than the pores of an element.
  if (drains && scene.moves()) scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  if (!given("name")) scene.name = std::filesystem::path(path).stem().string();
  if (!given("output.snapshot_every")) scene.output.snapshot_every = scene.output.every;
  if (!given("points.equal_volume") && scene.points.seeding == Seeding::gauss) {
    scene.points.equal_volume = false;
  }
  if (!given("initial.water_level")) scene.water_level = common_head(scene);
  if (!given("mesh.size") && given("geometry.shape")) {
    scene.mesh.size = default_size_of_shape(scene);
  }
  derive_skeletons(scene, given);
}

double default_element_size(double volume, int dimension, MeshStructure structure, bool from_file) {
  constexpr double wanted = 20000.0;
  const double size = std::pow(
      volume * elements_per_volume(dimension, structure, from_file) / wanted, 1.0 / dimension);
  if (!(size > 0.0) || !std::isfinite(size)) return unset;
  const double digit = std::pow(10.0, std::floor(std::log10(size)) - 1.0);
  return std::round(size / digit) * digit;  // two digits
}

std::string default_size_note(const SceneDocument& document, double size) {
  return "mesh.size was not given: " + short_number(size) + " m, for about 20 000 elements" +
         (counts_with_an_error(document)
              ? "; make study and make sweep mesh again until the discharge is known to 1 %"
              : "");
}

void complete_for_mesh(SceneDocument& document, int dimension) {
  if (dimension == 2 || document.where.contains("points.solid_per_element")) return;
  document.scene.points.solid_per_element = 4;
}

}  // namespace suffuse

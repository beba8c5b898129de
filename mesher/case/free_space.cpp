#include "case/free_space.hpp"

#include <algorithm>
#include <limits>

#include "physics/head.hpp"

namespace suffuse {

bool can_hold_air(const Scene& scene, const std::string& region) {
  return scene.is_free_water(region) && std::ranges::any_of(scene.soils, &Soil::drains);
}

template <int Dim>
std::string free_space_text(const Mesh<Dim>& mesh, const Scene& scene, int region) {
  const std::string& name = mesh.region_names[region];
  if (!scene.is_free_water(name)) return "";
  if (!can_hold_air(scene, name)) return "free water";
  const bool at_rest = scene.initial_flow == InitialFlow::rest && scene.initial_from.empty();
  if (!at_rest || !scene.water_level) return "air, or free water";
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.element_region[e] != region) continue;
    for (const int node : mesh.elements[e]) {
      const double z = height(mesh.nodes[node], scene.gravity);
      low = std::min(low, z);
      high = std::max(high, z);
    }
  }
  if (*scene.water_level <= low) return "air";
  return *scene.water_level >= high ? "free water" : "free water, air above it";
}

template std::string free_space_text(const Mesh<2>&, const Scene&, int);
template std::string free_space_text(const Mesh<3>&, const Scene&, int);

}  // namespace suffuse

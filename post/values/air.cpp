#include "values/air.hpp"

#include <algorithm>

#include "case/free_space.hpp"

namespace suffuse {

template <int Dim>
std::vector<bool> elements_of_air(const ResultsReader& run, std::size_t index,
                                  const Mesh<Dim>& mesh) {
  const Scene& scene = run.scene().scene;
  const auto is_open = [&](const std::string& region) { return can_hold_air(scene, region); };
  if (std::ranges::none_of(mesh.region_names, is_open)) return {};
  constexpr double soil_is_there = 0.8;  // porosity; a third of the element or more
  const auto porosity = run.field(index, "cell", "porosity").values;
  const auto saturation = run.field(index, "cell", "saturation").values;
  std::vector<bool> air;
  air.reserve(mesh.elements.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    air.push_back(is_open(mesh.region_names[mesh.element_region[e]]) &&
                  porosity[e] > soil_is_there && saturation[e] < 0.5);
  }
  return air;
}
template std::vector<bool> elements_of_air(const ResultsReader&, std::size_t, const Mesh<2>&);
template std::vector<bool> elements_of_air(const ResultsReader&, std::size_t, const Mesh<3>&);

Mesh<2> without(const Mesh<2>& mesh, const std::vector<bool>& elements) {
  if (elements.empty()) return mesh;
  Mesh<2> rest = mesh;
  rest.elements.clear();
  rest.element_region.clear();
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (elements[e]) continue;
    rest.elements.push_back(mesh.elements[e]);
    rest.element_region.push_back(mesh.element_region[e]);
  }
  return rest;
}

}  // namespace suffuse

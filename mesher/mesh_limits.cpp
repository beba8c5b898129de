#include "mesh_limits.hpp"

#include <cmath>
#include <vector>

#include "common/errors.hpp"
#include "common/short_number.hpp"

namespace suffuse {

namespace {

[[noreturn]] void refuse_size(const SceneDocument& document, double smallest,
                              const std::string& elements) {
  refuse_key(
      document, "mesh.size", short_number(document.scene.mesh.size),
      "at least " + short_number(smallest) + ", which makes 5 million " + elements + " here");
}

}  // namespace

void refuse_key(const SceneDocument& document, const std::string& key, const std::string& found,
                const std::string& expected) {
  throw InputError(
      std::vector<InputProblem>{{document.locate(key), key, found, expected, std::string()}});
}

void refuse_too_many_triangles(const SceneDocument& document, double area, double strip) {
  // Triangles fill half a square each: max_element_count = 2 (area + strip size) / size^2.
  const double smallest =
      (strip + std::sqrt(strip * strip + 2.0 * area * max_element_count)) / max_element_count;
  if (document.scene.mesh.size < smallest) refuse_size(document, smallest, "triangles");
}

void refuse_too_many_tetrahedra(const SceneDocument& document, double volume, double layer) {
  // Tetrahedra fill a sixth of a cube each: max_element_count = 6 (volume + layer size) / size^3.
  const auto count = [&](double size) {
    return 6.0 * (volume + layer * size) / (size * size * size);
  };
  double smallest = std::cbrt(6.0 * volume / max_element_count);
  while (count(smallest) > max_element_count * (1.0 + 1e-9)) {
    smallest = std::cbrt(6.0 * (volume + layer * smallest) / max_element_count);
  }
  if (document.scene.mesh.size < smallest) refuse_size(document, smallest, "tetrahedra");
}

}  // namespace suffuse

#include "mesh_limits.hpp"

#include <cmath>
#include <vector>

#include "common/errors.hpp"
#include "common/short_number.hpp"

namespace suffuse {

namespace {

/// A larger number is probably due to a misplaced decimal point.
constexpr double max_elements = 5e6;

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
  // Triangles fill half a square each: max_elements = 2 (area + strip size) / size^2.
  const double smallest =
      (strip + std::sqrt(strip * strip + 2.0 * area * max_elements)) / max_elements;
  if (document.scene.mesh.size < smallest) refuse_size(document, smallest, "triangles");
}

void refuse_too_many_tetrahedra(const SceneDocument& document, double volume, double layer) {
  // Tetrahedra fill a sixth of a cube each: max_elements = 6 (volume + layer size) / size^3.
  const auto count = [&](double size) {
    return 6.0 * (volume + layer * size) / (size * size * size);
  };
  double smallest = std::cbrt(6.0 * volume / max_elements);
  while (count(smallest) > max_elements * (1.0 + 1e-9)) {
    smallest = std::cbrt(6.0 * (volume + layer * smallest) / max_elements);
  }
  if (document.scene.mesh.size < smallest) refuse_size(document, smallest, "tetrahedra");
}

}  // namespace suffuse

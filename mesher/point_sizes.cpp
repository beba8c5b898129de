#include "point_sizes.hpp"

#include <gmsh.h>

#include <fstream>
#include <map>
#include <string>
#include <string_view>

#include "system_call_filter.hpp"

namespace suffuse {

namespace {

/// The size that Gmsh stores for a point without a size.
constexpr double no_size = 1e22;

struct Unrolled {
  gmsh::vectorpair points_without_size;
  bool has_sizes = false;
  bool has_field = false;
};

/// Reads `cl__1 = 1e+22;`, `Point(7) = {0, 0, 0, cl__1};`, `Transfinite Line {1} = 3 ...` and
/// `Background Field = 1;`.
Unrolled read_unrolled(std::istream& text) {
  constexpr std::string_view point_start = "Point(";
  std::map<std::string, double> sizes;
  Unrolled result;
  for (std::string line; std::getline(text, line);) {
    result.has_field = result.has_field || line.starts_with("Background Field");
    result.has_sizes = result.has_sizes || line.starts_with("Transfinite");
    const std::size_t assignment = line.find(" = ");
    if (assignment == std::string::npos) continue;
    if (line.starts_with("cl__")) {
      sizes[line.substr(0, assignment)] = std::stod(line.substr(assignment + 3));
    } else if (line.starts_with(point_start)) {
      const std::size_t name = line.rfind(' ') + 1;
      const auto size = sizes.find(line.substr(name, line.find('}') - name));
      if (size == sizes.end()) continue;  // a place on a curve, which is no point of the model
      if (size->second < no_size) {
        result.has_sizes = true;
      } else {
        result.points_without_size.emplace_back(0, std::stoi(line.substr(point_start.size())));
      }
    }
  }
  return result;
}

/// The API of Gmsh 4.8 sets sizes but does not tell them; its unrolled geometry does.
Unrolled unrolled_model() {
  const WritesToMemory memory;
  gmsh::write("model.geo_unrolled");
  std::ifstream stream(memory.path());
  return read_unrolled(stream);
}

}  // namespace

OwnSizes own_sizes() {
  const Unrolled unrolled = unrolled_model();
  double largest = no_size;
  double per_turn = 0.0;
  gmsh::option::getNumber("Mesh.MeshSizeMax", largest);
  gmsh::option::getNumber("Mesh.MeshSizeFromCurvature", per_turn);
  return {unrolled.has_sizes || unrolled.has_field || largest < no_size || per_turn > 0.0,
          unrolled.has_field};
}

void set_default_point_size(double size) {
  const gmsh::vectorpair points = unrolled_model().points_without_size;
  if (!points.empty()) gmsh::model::mesh::setSize(points, size);
}

}  // namespace suffuse

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

/// Reads `cl__1 = 1e+22;` and `Point(7) = {0, 0, 0, cl__1};`.
gmsh::vectorpair points_without_size(std::istream& unrolled) {
  constexpr std::string_view point_start = "Point(";
  std::map<std::string, double> sizes;
  gmsh::vectorpair points;
  for (std::string line; std::getline(unrolled, line);) {
    const std::size_t assignment = line.find(" = ");
    if (assignment == std::string::npos) continue;
    if (line.starts_with("cl__")) {
      sizes[line.substr(0, assignment)] = std::stod(line.substr(assignment + 3));
    } else if (line.starts_with(point_start)) {
      const std::size_t name = line.rfind(' ') + 1;
      const auto size = sizes.find(line.substr(name, line.find('}') - name));
      if (size == sizes.end() || size->second < no_size) continue;
      points.emplace_back(0, std::stoi(line.substr(point_start.size())));
    }
  }
  return points;
}

}  // namespace

void set_default_point_size(double size) {
  // The API of Gmsh 4.8 can set sizes but not return them; they are in its unrolled geometry.
  const WritesToMemory memory;
  gmsh::write("model.geo_unrolled");
  std::ifstream stream(memory.path());
  const gmsh::vectorpair points = points_without_size(stream);
  if (!points.empty()) gmsh::model::mesh::setSize(points, size);
}

}  // namespace suffuse

#include "stress/space_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "box_mesh.hpp"
#include "files/number_text.hpp"
#include "geometry.hpp"
#include "grid/grid.hpp"
#include "mesh/slit.hpp"
#include "stress/random_soil.hpp"
#include "stress/stress_case.hpp"

namespace suffuse::stress {
namespace {

/// The box as the mesher makes it for `shape = "box"`.
Mesh<3> built_in_box(Random& random, const Vector<3>& size, SpaceShape shape) {
  const bool layers = shape == SpaceShape::layers;
  std::string geometry = "geometry={shape = \"box\", " + entry("width", size[0]) + ", " +
                         entry("depth", size[1]) + ", " + entry("height", size[2]);
  if (layers) {
    const auto rows = [&] { return std::to_string(random.below(2)); };
    geometry += ", layers = {inflow = 1, free_above = " + rows() +
                ", above = 1, below = " + rows() + ", free_below = " + rows() + ", outflow = 1}";
  }
  const double h = std::min(size.minCoeff(), std::cbrt(size.prod() / random.between(20, 120)));
  const std::string structure = random.chance(layers ? 0.5 : 0.0) ? "regular" : "free";
  Changes changes{geometry + "}",
                  "mesh={" + entry("size", h) + ", " + word("structure", structure) + "}",
                  "boundary=[]"};
  if (layers) changes.emplace_back("soil.buffer.like=specimen");
  const std::string text = scene_text(Scheme::dp_implicit, 1.0);
  return build_geometry_of<3>(parse_scene(text, "stress.toml", changes)).mesh;
}

/// Opens a part of the plane between the first and the second half of the cells along x: all of
/// it, its lower part or a window at the corner in front.
void open_cut(Random& random, Mesh<3>& mesh, const std::array<int, 3>& cells, const Vector<3>& size,
              Cut cut) {
  const double x = size[0] * (cells[0] / 2) / cells[0];
  const auto part = [&](int d, double all) {
    return random.chance(all) ? size[d] : size[d] * (1 + random.below(cells[d] - 1)) / cells[d];
  };
  const double depth = part(1, 0.7);
  const double height = part(2, cut == Cut::any ? 0.5 : 0.0);
  BoundarySet<3> set{"cut", {}};
  const Grid<3> grid(mesh);
  for (int f = 0; f < grid.face_count(); ++f) {
    const Vector<3> centre = grid.face_centre(f);
    if (std::abs(centre[0] - x) > 1e-9 * size[0] || centre[1] > depth || centre[2] > height) {
      continue;
    }
    set.faces.push_back(grid.face_nodes[f]);
  }
  if (!slit(mesh, {set}).empty()) throw std::logic_error("a cut cannot be opened");
}

Mesh<3> regular_box(Random& random, const Vector<3>& size, SpaceShape shape, Cut cut) {
  const std::array<int, 3> cells{2 + random.below(4), 2 + random.below(4), 3 + random.below(6)};
  Mesh<3> mesh = model::box_mesh(cells, size);
  if (cut != Cut::none) open_cut(random, mesh, cells, size, cut);
  const double smallest =
      (size.array() / Vector<3>(cells[0], cells[1], cells[2]).array()).minCoeff();
  const double amount = random.chance(0.6) ? random.between(0.0, 0.2) * smallest : 0.0;
  const model::NodeMove move = model::disturbed(amount, size);
  const bool slopes = shape == SpaceShape::dam;
  const double water_side = slopes && random.chance(0.8) ? random.between(0.2, 2.0) : 0.0;
  const double land_side = slopes && random.chance(0.8) ? random.between(0.2, 2.0) : 0.0;
  for (Vector<3>& node : mesh.nodes) {
    const Vector<3> x = move(node);
    const double left = water_side * x[2];
    const double right = water_side + size[0] + land_side * (1.0 - x[2]);
    node = {std::lerp(left, right, x[0] / size[0]), x[1], x[2]};
  }
  return mesh;
}

/// Which of the soils a place has: a number from 0 on.
std::function<int(const Vector<3>&)> soil_places(Random& random, const Mesh<3>& mesh) {
  const Vector<3> size = extent(mesh);
  const int soils = 1 + random.below(4);
  const int axis = random.below(3);
  std::vector<double> borders;
  for (int i = 1; i < soils; ++i) borders.push_back(random.between(0.1, 0.9) * size[axis]);
  const double radius = random.between(0.2, 0.5);
  switch (random.below(5)) {
    case 0:
    case 1:  // layers
      return [=](const Vector<3>& x) {
        return static_cast<int>(
            std::ranges::count_if(borders, [&](double b) { return x[axis] > b; }));
      };
    case 2:  // a lens
      return [=](const Vector<3>& x) {
        return (x.cwiseQuotient(size) - Vector<3>::Constant(0.5)).norm() < radius ? 1 : 0;
      };
    case 3:  // pillars
      return [=](const Vector<3>& x) {
        return (x[0] < 0.5 * size[0] ? 0 : 1) + (x[1] < 0.5 * size[1] ? 0 : 2);
      };
    default:
      return [&random, soils](const Vector<3>&) { return random.below(soils); };
  }
}

}  // namespace

std::string name_of(SpaceShape shape) {
  switch (shape) {
    case SpaceShape::column:
      return "column";
    case SpaceShape::layers:
      return "column between layers";
    case SpaceShape::block:
      return "block";
    case SpaceShape::dam:
      return "dam";
  }
  throw std::logic_error("no such shape");
}

Mesh<3> space_mesh(unsigned seed, SpaceShape shape, Cut cut) {
  Random random(seed + 60000);
  const double width = random.between(0.3, 2.0);
  const double depth = random.between(0.3, 2.0);
  const Vector<3> size(width, depth, 1.0);
  if (shape == SpaceShape::layers) return built_in_box(random, size, shape);
  const bool by_gmsh = cut == Cut::none && shape != SpaceShape::dam && random.chance(0.4);
  Mesh<3> mesh =
      by_gmsh ? built_in_box(random, size, shape) : regular_box(random, size, shape, cut);
  const auto soil_at = soil_places(random, mesh);
  const std::array<std::string, 4> names{"specimen", "b", "c", "d"};
  name_regions(mesh, [&](const Vector<3>& x) { return names[soil_at(x)]; });
  if (std::ranges::find(mesh.region_names, names[0]) == mesh.region_names.end()) {
    mesh.region_names.front() = names[0];
  }
  return mesh;
}

}  // namespace suffuse::stress

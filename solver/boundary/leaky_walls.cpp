#include "boundary/leaky_walls.hpp"

#include <algorithm>

#include "physics/head.hpp"

namespace suffuse {

template <int Dim>
std::vector<LeakyFace> leaky_faces(const Case<Dim>& c, const Grid<Dim>& grid) {
  const Scene& scene = c.document.scene;
  // Both sides have equal heights: the difference of heads is that of pressures. Conductances, as
  // conductivities, are those under the gravity of the earth.
  const double pressure_per_head = unit_weight(scene.liquid.density, {});
  std::vector<LeakyFace> result;
  for (const Wall& wall : scene.walls) {
    if (wall.conductance == 0.0) continue;
    for (const BoundarySet<Dim>& set : c.mesh.boundaries) {
      if (set.name != wall.on) continue;
      for (std::size_t i = 0; i + 1 < set.faces.size(); i += 2) {
        const auto [face, partner] =
            std::minmax({grid.find_face(set.faces[i]), grid.find_face(set.faces[i + 1])});
        const double area = grid.face_normal[face].norm();
        result.push_back({face, partner, wall.conductance * area / pressure_per_head});
      }
    }
  }
  std::ranges::sort(result, {}, &LeakyFace::face);
  return result;
}

template <int Dim>
Grid<Dim> grid_with_walls(const Case<Dim>& c, const RankPart* part) {
  if (part != nullptr) return Grid<Dim>(c.mesh, *part);
  Grid<Dim> grid(c.mesh);
  std::vector<std::array<int, 2>> pairs;
  for (const LeakyFace& leaky : leaky_faces(c, grid)) pairs.push_back({leaky.face, leaky.partner});
  grid.join_faces(pairs);
  return grid;
}

template std::vector<LeakyFace> leaky_faces(const Case<2>&, const Grid<2>&);
template std::vector<LeakyFace> leaky_faces(const Case<3>&, const Grid<3>&);
template Grid<2> grid_with_walls(const Case<2>&, const RankPart*);
template Grid<3> grid_with_walls(const Case<3>&, const RankPart*);

}  // namespace suffuse

#include "equilibrium/sharing_volumes.hpp"

#include <algorithm>

namespace suffuse {
namespace {

/// Elastic soil of a higher Poisson's ratio is so stiff against changes of its volume that linear
/// displacements lock.
constexpr double least_locking_poisson = 0.4;

/// Per triangle: whether it lies at a surface of the soil that nothing holds.
template <int Dim>
std::vector<char> surface_triangles(const SolidBody<Dim>& body, const Supports<Dim>& supports) {
  const Grid<Dim>& grid = body.grid;
  std::vector<char> result(grid.mesh.elements.size(), 0);
  if (Dim == 3) return result;
  std::vector<char> is_free(grid.mesh.node_count(), 0);
  for (int f = 0; f < grid.face_count(); ++f) {
    if (!grid.is_outer(f)) continue;
    for (const int i : grid.face_nodes[f]) is_free[i] = supports.free_count(i) == Dim ? 1 : 0;
  }
  for (std::size_t e = 0; e < result.size(); ++e) {
    if (body.classes.full[e] < 1.0) result[e] = 1;
    for (const int i : grid.mesh.elements[e]) result[e] = std::max(result[e], is_free[i]);
  }
  return result;
}

}  // namespace

template <int Dim>
std::vector<double> sharing_volumes(const SolidBody<Dim>& body, const Supports<Dim>& supports,
                                    std::vector<double> volume) {
  const auto locks = [&](int p) {
    const auto& [law, parameters] = body.skeleton[p];
    return law->yields() || parameters.poisson > least_locking_poisson;
  };
  const auto has_friction = [&](int p) { return body.skeleton[p].parameters.friction > 0.0; };
  const std::vector<char> is_at_surface = surface_triangles(body, supports);
  for (int e = 0; e < body.grid.mesh.element_count(); ++e) {
    const auto& points = body.sorted.of(e);
    if (supports.is_rigid(e) || std::ranges::none_of(points, locks) ||
        (is_at_surface[e] != 0 && std::ranges::any_of(points, has_friction))) {
      volume[e] = 0.0;
    }
  }
  return volume;
}

template std::vector<double> sharing_volumes(const SolidBody<2>&, const Supports<2>&,
                                             std::vector<double>);
template std::vector<double> sharing_volumes(const SolidBody<3>&, const Supports<3>&,
                                             std::vector<double>);

}  // namespace suffuse

#include "boundary/free_water.hpp"

#include <algorithm>
#include <array>

#include "boundary/loads.hpp"

namespace suffuse {
namespace {

/// A pressure that varies linearly over a face presses on its `a`-th node as much as a constant
/// pressure does: the pressure at this place.
template <int Dim>
Vector<Dim> weighted_place(const Grid<Dim>& grid, const std::array<int, Dim>& face, std::size_t a) {
  Vector<Dim> sum = grid.mesh.nodes[face[a]];
  for (const int i : face) sum += grid.mesh.nodes[i];
  return sum / (Dim + 1);
}

}  // namespace

template <int Dim>
bool has_free_water(const Grid<Dim>& grid, const SoilMap<Dim>& soils) {
  return std::ranges::any_of(grid.mesh.region_names, [&](const std::string& region) {
    return soils.scene().is_free_water(region);
  });
}

template <int Dim>
void add_free_water(const Grid<Dim>& grid, const PointsByElement& sorted,
                    const std::vector<double>& soil_volume, const std::vector<double>& pressure,
                    const std::vector<double>& liquid_mass, const std::array<double, 3>& gravity,
                    NodalLoads<Dim>& loads) {
  const Vector<Dim> g = Eigen::Map<const Vector<Dim>>(gravity.data());
  const std::vector<char> of_soil = nodes_of_soil(grid, sorted);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const double volume = grid.volume[e] - soil_volume[e];
    const Vector<Dim> weight = liquid_mass[e] * volume / (Dim + 1) * g;
    const auto& nodes = grid.mesh.elements[e];
    loads.add(
        nodes, [&](std::size_t) { return Vector<Dim>(weight); }, EdgeShare<Dim>::volume, of_soil);
    if (!sorted.is_empty(e)) continue;
    const auto of_pressure = [&](std::size_t a) {
      return Vector<Dim>(pressure[e] * grid.volume[e] * grid.shape_gradient[e][a]);
    };
    loads.add(nodes, of_pressure, EdgeShare<Dim>::stress, of_soil);
    // The outer boundary carries the water beside it, not the soil at its edge.
    for (int k = 0; k <= Dim; ++k) {
      if (grid.across(e, k) >= 0) continue;
      const auto& face = grid.face_nodes[grid.element_face[e][k]];
      const auto against = [&](std::size_t a) {
        const Vector<Dim> place =
            weighted_place<Dim>(grid, face, a) - element_centroid(grid.mesh, e);
        const double p = pressure[e] + liquid_mass[e] * g.dot(place);
        return Vector<Dim>(p * grid.volume[e] * grid.shape_gradient[e][k]);  // -p A n / d
      };
      loads.add(face, against, EdgeShare<Dim>::face, of_soil);
    }
  }
}

template <int Dim>
void add_free_water_mass(const Grid<Dim>& grid, const PointsByElement& sorted,
                         const std::vector<double>& soil_volume,
                         const std::vector<double>& liquid_mass, std::vector<double>& mass) {
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (sorted.is_empty(e)) continue;
    // Points may crowd in an element: it holds no other water then.
    const double rest = std::max(0.0, grid.volume[e] - soil_volume[e]);
    const double of_node = liquid_mass[e] * rest / (Dim + 1);
    for (const int i : grid.mesh.elements[e]) mass[i] += of_node;
  }
}

template bool has_free_water(const Grid<2>&, const SoilMap<2>&);
template bool has_free_water(const Grid<3>&, const SoilMap<3>&);
template void add_free_water(const Grid<2>&, const PointsByElement&, const std::vector<double>&,
                             const std::vector<double>&, const std::vector<double>&,
                             const std::array<double, 3>&, NodalLoads<2>&);
template void add_free_water(const Grid<3>&, const PointsByElement&, const std::vector<double>&,
                             const std::vector<double>&, const std::vector<double>&,
                             const std::array<double, 3>&, NodalLoads<3>&);
template void add_free_water_mass(const Grid<2>&, const PointsByElement&,
                                  const std::vector<double>&, const std::vector<double>&,
                                  std::vector<double>&);
template void add_free_water_mass(const Grid<3>&, const PointsByElement&,
                                  const std::vector<double>&, const std::vector<double>&,
                                  std::vector<double>&);

}  // namespace suffuse

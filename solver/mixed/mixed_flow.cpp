#include "mixed/mixed_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid/face_flux.hpp"
#include "grid/parallel.hpp"

namespace suffuse {

template <int Dim>
std::vector<double> element_pressure(const Grid<Dim>& grid,
                                     const std::vector<double>& face_pressure, int threads) {
  std::vector<double> result(grid.mesh.element_count(), 0.0);
  for_each_index(grid.mesh.element_count(), threads, [&](int e) {
    for (const int f : grid.element_face[e]) result[e] += face_pressure[f] / (Dim + 1);
  });
  return result;
}

template <int Dim>
FaceVolumes face_volumes(const Grid<Dim>& grid, const std::vector<double>& start_face,
                         const std::vector<double>& start_element, const MixedStep<Dim>& step,
                         double bulk_modulus, int threads) {
  FaceVolumes result{step.face_volume, std::vector<double>(grid.face_count(), 0.0)};
  if (std::isinf(bulk_modulus)) return result;
  const std::vector<double> end = element_pressure(grid, step.end.face_pressure, threads);
  for_each_index(grid.face_count(), threads, [&](int f) {
    const double volume = step.face_volume[f];
    const int from = volume < 0.0 ? grid.beyond(f) : grid.face_left[f];
    const double upwind = from >= 0 ? 0.5 * (start_element[from] + end[from])
                                    : 0.5 * (start_face[f] + step.end.face_pressure[f]);
    result.density_excess[f] = volume * std::expm1(upwind / bulk_modulus);
  });
  grid.face_rows().exchange(result.density_excess);
  return result;
}

namespace {

/// See `nodal_fields`.
template <int Dim>
void limit_to_surroundings(const Grid<Dim>& grid, const std::vector<double>& face_pressure,
                           const std::vector<double>& element_pressure, const Vector<Dim>& weight,
                           std::vector<double>& node_pressure) {
  for (int i = 0; i < grid.mesh.node_count(); ++i) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    const auto include = [&](double pressure, const Vector<Dim>& place) {
      const double here = pressure + weight.dot(grid.mesh.nodes[i] - place);
      low = std::min(low, here);
      high = std::max(high, here);
    };
    for (int k = grid.node_face_begin[i]; k < grid.node_face_begin[i + 1]; ++k) {
      const int f = grid.node_face[k];
      include(face_pressure[f], grid.face_centre(f));
    }
    for (int k = grid.node_element_begin[i]; k < grid.node_element_begin[i + 1]; ++k) {
      const int e = grid.node_element[k];
      include(element_pressure[e], element_centroid(grid.mesh, e));
    }
    node_pressure[i] = std::clamp(node_pressure[i], low, high);
  }
}

}  // namespace

template <int Dim>
NodalFields<Dim> nodal_fields(const Grid<Dim>& grid, const MixedFlow<Dim>& flow,
                              const std::vector<double>& element_pressure,
                              const std::vector<double>& porosity, const Vector<Dim>& weight) {
  NodalFields<Dim> result{std::vector<double>(grid.mesh.node_count(), 0.0),
                          VectorField<Dim>(grid.mesh.node_count(), Vector<Dim>::Zero())};
  const std::vector<Vector<Dim>> flux = element_flux(grid, flow.face_flux);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    for (int k = 0; k <= Dim; ++k) {
      const int i = grid.mesh.elements[e][k];
      const double share = grid.volume[e] / (Dim + 1) / grid.node_volume[i];
      const double at_vertex =
          (Dim + 1) * element_pressure[e] - Dim * flow.state.face_pressure[grid.element_face[e][k]];
      result.pressure[i] += share * at_vertex;
      result.velocity[i] += share / porosity[e] * flux[e];
    }
  }
  limit_to_surroundings(grid, flow.state.face_pressure, element_pressure, weight, result.pressure);
  return result;
}

template std::vector<double> element_pressure(const Grid<2>&, const std::vector<double>&, int);
template FaceVolumes face_volumes(const Grid<2>&, const std::vector<double>&,
                                  const std::vector<double>&, const MixedStep<2>&, double, int);
template NodalFields<2> nodal_fields(const Grid<2>&, const MixedFlow<2>&,
                                     const std::vector<double>&, const std::vector<double>&,
                                     const Vector<2>&);
template std::vector<double> element_pressure(const Grid<3>&, const std::vector<double>&, int);
template FaceVolumes face_volumes(const Grid<3>&, const std::vector<double>&,
                                  const std::vector<double>&, const MixedStep<3>&, double, int);
template NodalFields<3> nodal_fields(const Grid<3>&, const MixedFlow<3>&,
                                     const std::vector<double>&, const std::vector<double>&,
                                     const Vector<3>&);

}  // namespace suffuse

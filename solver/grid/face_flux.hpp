#pragma once

/// What fluxes through the faces of an element say of it: its net outflow, and the flux at a place
/// in it, the Raviart-Thomas field of lowest order.

#include <vector>

#include "grid/grid.hpp"

namespace suffuse {

/// Flux at a place of the element, in the unit of `face_flux` (along each face's normal) per area:
/// m/s from m3/s, m from m3.
template <int Dim>
Vector<Dim> flux_at(const Grid<Dim>& grid, const std::vector<double>& face_flux, int element,
                    const Vector<Dim>& place) {
  Vector<Dim> result = Vector<Dim>::Zero();
  for (int k = 0; k <= Dim; ++k) {
    result += grid.element_face_sign[element][k] * face_flux[grid.element_face[element][k]] *
              (place - grid.mesh.nodes[grid.mesh.elements[element][k]]);
  }
  return result / (Dim * grid.volume[element]);
}

/// Net outflow of an element, from values at faces along their normals, in the unit of the values.
template <int Dim>
double outflow(const Grid<Dim>& grid, int element, const std::vector<double>& face_values) {
  double sum = 0.0;
  for (int k = 0; k <= Dim; ++k) {
    sum += grid.element_face_sign[element][k] * face_values[grid.element_face[element][k]];
  }
  return sum;
}

/// Flux at the centroid of each element, in the unit of `face_flux` per area.
template <int Dim>
std::vector<Vector<Dim>> element_flux(const Grid<Dim>& grid, const std::vector<double>& face_flux) {
  std::vector<Vector<Dim>> result(grid.mesh.element_count());
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    result[e] = flux_at(grid, face_flux, e, element_centroid(grid.mesh, e));
  }
  return result;
}

/// Mean fluxes through faces, m3/s, from volumes over `duration` seconds.
inline std::vector<double> per_time(std::vector<double> volumes, double duration) {
  for (double& v : volumes) v /= duration;
  return volumes;
}

}  // namespace suffuse

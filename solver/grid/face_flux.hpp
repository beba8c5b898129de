#pragma once

/// The field of lowest order of Raviart and Thomas inside an element, from the fluxes through its
/// faces.

#include <algorithm>
#include <vector>

#include "case/material_points.hpp"
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

/// The same at the centroid of each element.
template <int Dim>
std::vector<Vector<Dim>> element_flux(const Grid<Dim>& grid, const std::vector<double>& face_flux) {
  std::vector<Vector<Dim>> result(grid.mesh.element_count());
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    result[e] = flux_at(grid, face_flux, e, element_centroid(grid.mesh, e));
  }
  return result;
}

/// Its magnitude at material points, times `scale`.
template <int Dim>
std::vector<double> flux_magnitude_at(const Grid<Dim>& grid, const std::vector<double>& face_flux,
                                      const MaterialPoints<Dim>& points, double scale) {
  std::vector<double> result(points.size());
  for (int p = 0; p < points.size(); ++p) {
    result[p] =
        scale * flux_at(grid, face_flux, points.element[p], points.position(grid.mesh, p)).norm();
  }
  return result;
}

/// Fluxes through faces over an interval, linear in time, and how much of it is past.
struct FluxInTime {
  std::vector<double> mean;    ///< m3/s
  std::vector<double> change;  ///< from the begin of the interval to its end, m3/s; empty: none
  double share = 1.0;          ///< of the interval
};

/// Mean of the flux's magnitude over the share that is past, m/s. What it comes to in that time
/// only grows with the share, also where the flux turns; over the whole interval it is the
/// magnitude of the mean.
template <int Dim>
double mean_magnitude_at(const Grid<Dim>& grid, const FluxInTime& flux, int element,
                         const Vector<Dim>& place) {
  const Vector<Dim> mean = flux_at(grid, flux.mean, element, place);
  if (flux.change.empty() || flux.share >= 1.0) return mean.norm();
  // The magnitude as linear between so many moments: exact where the flux does not turn.
  constexpr int pieces = 4;
  const Vector<Dim> change = flux_at(grid, flux.change, element, place);
  const auto magnitude = [&](double share) { return (mean + (share - 0.5) * change).norm(); };
  double past = 0.0;
  double all = 0.0;
  for (int k = 0; k < pieces; ++k) {
    const double from = magnitude(static_cast<double>(k) / pieces);
    const double to = magnitude(static_cast<double>(k + 1) / pieces);
    const double done = std::clamp(pieces * flux.share - k, 0.0, 1.0);
    past += done * (from + 0.5 * done * (to - from));
    all += 0.5 * (from + to);
  }
  return all > 0.0 ? mean.norm() * past / (all * flux.share) : 0.0;
}

/// Fluxes through faces on the mean, m3/s, from volumes over `duration` seconds.
inline std::vector<double> per_time(std::vector<double> volumes, double duration) {
  for (double& v : volumes) v /= duration;
  return volumes;
}

}  // namespace suffuse

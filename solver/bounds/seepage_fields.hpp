#pragma once

/// Steady saturated seepage as a linear problem in heads, and approximate fields of it: q = -K grad
/// h, div q = 0, with K a tensor per element. Walls that let water through are part of the energy.

#include <array>
#include <vector>

#include "boundary/leaky_walls.hpp"
#include "grid/element_field.hpp"
#include "grid/grid.hpp"
#include "mixed/flow_soils.hpp"

namespace suffuse {

/// Mean over a face of the product of two functions that are linear there, from their values at its
/// nodes.
template <std::size_t Nodes>
double mean_product(const std::array<double, Nodes>& a, const std::array<double, Nodes>& b) {
  double sum_a = 0.0;
  double sum_b = 0.0;
  double both = 0.0;
  for (std::size_t i = 0; i < Nodes; ++i) {
    sum_a += a[i];
    sum_b += b[i];
    both += a[i] * b[i];
  }
  return (both + sum_a * sum_b) / static_cast<double>(Nodes * (Nodes + 1));
}

/// A wall face with its nodes on both sides, at the same places.
template <int Dim>
struct WallNodes {
  int face = -1;
  int partner = -1;
  std::array<int, Dim> near = {};
  std::array<int, Dim> far = {};
  double conductance = 0.0;  ///< flux through the face per difference of head, m2/s
};

/// Slopes of a head: a gradient per element, 1, and differences across walls at their nodes, m.
template <int Dim>
struct Slopes {
  std::vector<Vector<Dim>> element;
  std::vector<std::array<double, Dim>> wall;
};

template <int Dim>
class SeepageEnergy {
 public:
  /// `conductivity` along the bedding, m/s, and `bedding`, per element; the latter may be empty.
  /// `pressure_per_head` in Pa/m.
  SeepageEnergy(const Grid<Dim>& grid, std::vector<double> conductivity,
                std::vector<DirectionalFactor<Dim>> bedding, const std::vector<LeakyFace>& walls,
                double pressure_per_head);

  [[nodiscard]] const Grid<Dim>& grid() const { return grid_; }
  [[nodiscard]] const std::vector<WallNodes<Dim>>& walls() const { return walls_; }
  /// K times a vector.
  [[nodiscard]] Vector<Dim> conduct(int e, const Vector<Dim>& v) const {
    return conductivity_[e] * (bedding_.empty() ? v : bedding_[e].times(v));
  }
  /// K^-1 times a vector.
  [[nodiscard]] Vector<Dim> resist(int e, const Vector<Dim>& v) const {
    return (bedding_.empty() ? v : bedding_[e].inverse_times(v)) / conductivity_[e];
  }
  /// Mean conductivity of an element over the directions, m/s.
  [[nodiscard]] double mean_conductivity(int e) const {
    return conductivity_[e] * (bedding_.empty() ? 1.0 : bedding_[e].trace() / Dim);
  }

  /// Slopes of the continuous head that is linear in each element; per node, m.
  [[nodiscard]] Slopes<Dim> of_head(const std::vector<double>& node_head) const;
  /// -K^-1 q of fluxes that balance in each element; along the faces' normals, m3/s.
  [[nodiscard]] Slopes<Dim> of_flux(const std::vector<double>& face_flux) const;

  /// Integral of a . K b over an element, with half of each of its walls, m3/s times m.
  [[nodiscard]] std::vector<double> per_element(const Slopes<Dim>& a, const Slopes<Dim>& b) const;
  /// Its sum over the elements.
  [[nodiscard]] double inner(const Slopes<Dim>& a, const Slopes<Dim>& b) const;

 private:
  const Grid<Dim>& grid_;
  std::vector<double> conductivity_;
  std::vector<DirectionalFactor<Dim>> bedding_;
  std::vector<WallNodes<Dim>> walls_;
};

/// Slope in each element of values at the centres of its faces.
template <int Dim>
std::vector<Vector<Dim>> face_slopes(const Grid<Dim>& grid, const std::vector<double>& at_faces);

/// a + factor b.
template <int Dim>
Slopes<Dim> sum(const Slopes<Dim>& a, double factor, const Slopes<Dim>& b);

}  // namespace suffuse

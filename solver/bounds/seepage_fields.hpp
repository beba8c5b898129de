#pragma once

/// Steady saturated seepage as a linear problem in heads, and approximate fields of it: q = -K grad
/// h, div q = 0, with K a tensor per element. Walls that let water through are part of the energy.

#include <array>
#include <vector>

#include "boundary/leaky_walls.hpp"
#include "grid/element_field.hpp"
#include "grid/grid.hpp"
#include "mixed/directional_factor.hpp"

namespace suffuse {

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

/// a + factor b.
template <int Dim>
Slopes<Dim> sum(const Slopes<Dim>& a, double factor, const Slopes<Dim>& b);

}  // namespace suffuse

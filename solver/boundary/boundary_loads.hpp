#pragma once

/// What the scene's boundaries do to the soil: where they hold it, and what they load it with.

#include <vector>

#include "equilibrium/loads.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// Where the scene holds the soil: at boundaries with `fix`, and all nodes of soil whose skeleton
/// is rigid.
template <int Dim>
Supports<Dim> scene_supports(const Grid<Dim>& grid, const SoilMap<Dim>& soils);

/// Tractions of the scene, and the weight of the water that a head keeps outside: its pressure,
/// normal to the soil. A boundary with both has the traction alone.
template <int Dim>
class BoundaryLoads {
 public:
  /// \param sorted  the points by element
  BoundaryLoads(const Grid<Dim>& grid, const SoilMap<Dim>& soils, const PointsByElement& sorted);

  /// Adds the forces at a time, s, to those on the nodes, N.
  void add(const PointsByElement& sorted, double time, NodeVectors<Dim>& loads) const;
  /// Times at which a traction has a kink, s. Those of heads are kinks of the flow already.
  [[nodiscard]] std::vector<double> breakpoints() const;
  /// Largest difference of a traction from that at the start, Pa.
  [[nodiscard]] double largest_change() const;
  /// Moves the loaded surfaces with the soil. Throws NumericalError where one would leave the mesh;
  /// all are then as they were.
  void move(const PointsByElement& sorted, const NodeVectors<Dim>& displacement);

  void archive(auto& archive) { archive(surfaces_); }

 private:
  const Grid<Dim>& grid_;
  const Scene& scene_;
  std::vector<int> boundary_;  ///< per surface: index of the scene's boundary entry
  std::vector<LoadedSurface<Dim>> surfaces_;
};

}  // namespace suffuse

#pragma once

/// Supports and loads of the soil at the scene's boundaries.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "boundary/loads.hpp"
#include "boundary/virtual_stress.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// Supports of the scene: boundaries with `fix`, both sides of walls and wells along their normal,
/// and all nodes of soil with a rigid skeleton.
template <int Dim>
Supports<Dim> scene_supports(const Grid<Dim>& grid, const SoilMap<Dim>& soils);

/// Loads of the scene: tractions, and the pressure of the outer water at boundaries with a head. If
/// a boundary has both, only the traction acts.
template <int Dim>
class BoundaryLoads {
 public:
  /// \param sorted  the points by element
  BoundaryLoads(const Grid<Dim>& grid, const SoilMap<Dim>& soils, const PointsByElement& sorted);

  /// Adds the forces at a time, s, to `loads`, N.
  /// \param soil_volume  see `soil_volumes`
  void add(const PointsByElement& sorted, const std::vector<double>& soil_volume, double time,
           NodalLoads<Dim>& loads) const;
  /// Times at which a traction has a kink, s. The kinks of heads are breakpoints of the flow.
  [[nodiscard]] std::vector<double> breakpoints() const;
  /// Largest difference of a traction from that at the start, Pa.
  [[nodiscard]] double largest_change() const;
  /// Moves the surfaces with a traction. Throws NumericalError if one would leave the mesh;
  /// then none has moved.
  void move(const PointsByElement& sorted, const NodeVectors<Dim>& displacement);

  /// The surfaces with a traction by the name of their boundary.
  [[nodiscard]] std::map<std::string, LoadedSurface<Dim>> surfaces() const;
  /// Sets surfaces to the places where another run has left those of the same boundary, if they
  /// started on the same faces.
  void place(const std::map<std::string, LoadedSurface<Dim>>& surfaces);

  void archive(auto& archive) { archive(surfaces_); }

 private:
  /// Adds the pressure of outer water of a head, m, on faces.
  void add_water(const std::vector<int>& faces, double head, const PointsByElement& sorted,
                 NodalLoads<Dim>& loads) const;
  /// Adds the weight of the outer water above the soil in the elements at these faces. Leaves out
  /// elements that are marked in `weighed`, and marks those whose water it adds.
  void add_weight(const std::vector<int>& faces, double head, const PointsByElement& sorted,
                  const std::vector<double>& soil_volume, std::vector<char>& weighed,
                  NodalLoads<Dim>& loads) const;
  void add_traction(std::size_t surface, const PointsByElement& sorted,
                    const std::vector<double>& soil_volume, const Vector<Dim>& traction,
                    NodalLoads<Dim>& loads) const;

  const Grid<Dim>& grid_;
  const Scene& scene_;
  std::vector<int> boundary_;  ///< per surface: index of the scene's boundary entry
  std::vector<LoadedSurface<Dim>> surfaces_;
  std::vector<VirtualStress<Dim>> stress_;  ///< per surface
  /// Boundaries under outer water, by index, and their faces. The pore pressure of an element acts
  /// on all of its volume, water above the soil included, so outer water presses on faces of the
  /// mesh: on a surface that sinks with the soil the difference would strain the topmost points,
  /// the more the deeper the water is.
  std::vector<std::pair<int, std::vector<int>>> water_;
  bool has_free_water_;
};

}  // namespace suffuse

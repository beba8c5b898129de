#pragma once

/// Loads on the solid.

#include <array>
#include <vector>

#include "boundary/nodal_loads.hpp"
#include "solid/element_classes.hpp"

namespace suffuse {

/// Adds forces at solid points, N per point. On quadratic displacements they act as if spread over
/// the element, as the stress does.
template <int Dim>
void add_point_forces(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                      const std::vector<Vector<Dim>>& force, NodalLoads<Dim>& loads);

/// Mass of the soil.
struct SoilMass {
  std::vector<double> solid;   ///< per point, kg
  std::vector<double> liquid;  ///< per volume of soil and element, kg/m3; empty: none
};

/// Loads on the nodes, N, and the unit weight of soil with its water per element, N/m3.
template <int Dim>
struct SoilLoads {
  NodeVectors<Dim> forces;
  std::vector<Vector<Dim>> weight;
};

/// Adds the weight of the solid at its points and of the liquid in its pores, N.
/// \param soil_volume  see `soil_volumes`; `gravity` in m/s2
template <int Dim>
void add_weight(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                const std::vector<double>& soil_volume, const SoilMass& mass,
                const std::array<double, 3>& gravity, NodalLoads<Dim>& loads);

/// Unit weight of the soil with its water per element, N/m3: what `add_weight` adds over the volume
/// of the soil; 0 without soil.
template <int Dim>
std::vector<Vector<Dim>> unit_weights(const SolidPoints<Dim>& points,
                                      const std::vector<double>& soil_volume, const SoilMass& mass,
                                      const std::array<double, 3>& gravity);

/// The element with soil at a face; at the border of the mesh the only one.
template <int Dim>
int soil_at(const Grid<Dim>& grid, const PointsByElement& sorted, int face);

/// Per node: whether it belongs to an element with soil.
template <int Dim>
std::vector<char> nodes_of_soil(const Grid<Dim>& grid, const PointsByElement& sorted);

/// A surface of the soil that carries a load. It starts on faces of the mesh and moves with the
/// soil, so it may come to lie inside elements: places on it represent shares of its area. (Loading
/// the topmost solid points instead would put the load below the surface.) Its faces move with
/// their corners, which they share: the area in any direction does not change but at its border,
/// however uneven the motion of the nodes beside the soil is.
template <int Dim>
class LoadedSurface {
 public:
  LoadedSurface() = default;
  /// \param faces  of the grid, at its border or between an element with soil and one without
  LoadedSurface(const Grid<Dim>& grid, const PointsByElement& sorted,
                const std::vector<int>& faces);

  /// Adds a traction, Pa, on the area that the surface had at the start: a dead load. If the
  /// element of a place has no soil left, the nearest element with soil below takes the load with
  /// its linear functions extrapolated to the place: forces and moments do not change.
  void add_traction(const Grid<Dim>& grid, const PointsByElement& sorted,
                    const Vector<Dim>& traction, NodalLoads<Dim>& loads) const;

  /// Adds a pressure `pressure(x)`, Pa, which may vary in space, normal to the present surface.
  template <class Pressure>
  void add_pressures(const Grid<Dim>& grid, const PointsByElement& sorted, const Pressure& pressure,
                     NodalLoads<Dim>& loads) const {
    for (int i = 0; i < static_cast<int>(area_.size()); ++i) {
      add_force(grid, sorted, i, -pressure(position_[i]) * normal_[i], loads);
    }
  }

  /// Moves with the soil. A place slightly above the mesh loads the last element. Throws
  /// NumericalError if it rises by more than half an element.
  void move(const Grid<Dim>& grid, const PointsByElement& sorted,
            const NodeVectors<Dim>& displacement);

  [[nodiscard]] const std::vector<Vector<Dim>>& places() const { return position_; }
  /// Whether both started on the same faces of the mesh.
  [[nodiscard]] bool starts_as(const LoadedSurface& other) const { return start_ == other.start_; }
  void archive(auto& archive) {
    archive(start_, corner_, face_, position_, element_, area_, normal_);
  }

 private:
  /// Finds the places and normals of the faces from their corners.
  void follow_corners(const Grid<Dim>& grid);
  void add_force(const Grid<Dim>& grid, const PointsByElement& sorted, int place,
                 const Vector<Dim>& force, NodalLoads<Dim>& loads) const;

  std::vector<int> start_;                  ///< faces of the mesh
  std::vector<Vector<Dim>> corner_;         ///< m
  std::vector<std::array<int, Dim>> face_;  ///< corners, in the order of their vector area
  // Per place, `Dim` of each face:
  std::vector<Vector<Dim>> position_;  ///< m
  std::vector<int> element_;           ///< of the soil below
  std::vector<double> area_;           ///< at the start, m2
  std::vector<Vector<Dim>> normal_;    ///< out of the soil, times the present area
};

/// Direction of gravity; without gravity, that of -y.
template <int Dim>
Vector<Dim> downwards(const std::array<double, 3>& gravity);

}  // namespace suffuse

#pragma once

/// A traction on soil whose surface has left the faces of the mesh on which it started.

#include <vector>

#include "boundary/nodal_loads.hpp"

namespace suffuse {

/// Between the faces of the mesh and the soil that has sunk below them a traction t acts as a
/// uniform stress s with s n = t, n the normal of the faces (a virtual stress boundary, as of
/// Liang, Given and Soga, Comput. Methods Appl. Mech. Eng., 2023). Its forces on the nodes are
/// those of the traction on the faces minus the integral of the stress over the volume that the
/// soil has left. The soil below then has the stress that balances the traction, wherever its
/// points lie in their elements. A force at the place of the surface fits the volume of these
/// points only nearly, and the stress of the topmost points is wrong.
template <int Dim>
class VirtualStress {
 public:
  /// \param sorted  the points by element at the start
  /// \param faces   of the grid, on which the traction acts at the start
  /// \param places  on the faces, which move with the soil, m; as many on each face
  VirtualStress(const Grid<Dim>& grid, const PointsByElement& sorted, std::vector<int> faces,
                std::vector<Vector<Dim>> places);

  /// Adds the forces of a traction, Pa, to `loads`, N, or nothing and returns false if less than
  /// half of the load reaches soil.
  ///
  /// \param soil_volume  see `soil_volumes`
  bool add(const Grid<Dim>& grid, const PointsByElement& sorted,
           const std::vector<double>& soil_volume, const Vector<Dim>& traction,
           NodalLoads<Dim>& loads) const;
  /// Share of a load that acts so: all as long as its places have moved sideways by less than half
  /// an element, nothing from one element on. Soil that runs out takes its load along.
  [[nodiscard]] double share(const Grid<Dim>& grid, const std::vector<Vector<Dim>>& places) const;

 private:
  /// Finds the elements behind a face, along its normal, and marks them in `is_covered`.
  /// `visited`: per element, the face for which it was looked at last.
  void cover(const Grid<Dim>& grid, const PointsByElement& sorted, int face,
             std::vector<char>& is_covered, std::vector<int>& visited);

  /// An element with soil at the start behind a face.
  struct Covered {
    int element;
    int face;  ///< index in `faces_`
  };

  std::vector<int> faces_;
  std::vector<Vector<Dim>> normal_;  ///< per face, out of the soil, times its area
  std::vector<Vector<Dim>> start_;   ///< the places at the start, m
  std::vector<Covered> covered_;
};

}  // namespace suffuse

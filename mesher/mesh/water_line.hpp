#pragma once

/// Finds the faces of a boundary under the water level of its `head`.

#include <array>

#include "mesh/mesh.hpp"

namespace suffuse {

/// A face is under water as a whole if its centre is below the level, or if it is horizontal and
/// the water just reaches it.
template <int Dim>
class WaterLine {
 public:
  /// `gravity` in m/s2, not zero; `largest_coordinate` of the whole mesh, of which `mesh` may be a
  /// part, m.
  WaterLine(const Mesh<Dim>& mesh, const std::array<double, 3>& gravity, double largest_coordinate);
  /// Height of the centre of a face, m.
  [[nodiscard]] double centre_height(const std::array<int, Dim>& face) const;
  /// A face is under water if the head exceeds this value, m: the height of its centre; for a level
  /// face, a little less, so that a head equal to its height counts as water although the
  /// coordinates are rounded.
  [[nodiscard]] double wet_above(const std::array<int, Dim>& face) const;

 private:
  const Mesh<Dim>& mesh_;
  std::array<double, 3> gravity_;
  double round_off_ = 0.0;  ///< error of heights, m
};

}  // namespace suffuse

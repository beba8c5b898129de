#pragma once

/// Places and lines in a mesh, and the liquid that crosses a line.

#include <optional>
#include <vector>

#include "grid/point_place.hpp"
#include "ranks/exact_sum.hpp"

namespace suffuse {

/// The element that holds a place; if several do, the first of those in which it is deepest.
/// Nothing if it is outside the mesh.
template <int Dim>
std::optional<PointPlace<Dim>> find_place(const Grid<Dim>& grid, const Vector<Dim>& x);

/// A straight line through the mesh, as a sum over faces. The flux in an element is linear
/// (`flux_at`), so the midpoint of each piece of the line gives its flux exactly. Where the line
/// runs along faces, each piece counts once; parts outside the mesh do not count.
class SectionLine {
 public:
  /// All ranks have to call it.
  SectionLine(const Grid<2>& grid, const Vector<2>& from, const Vector<2>& to);

  /// Length within the mesh, m.
  [[nodiscard]] double length() const { return length_; }
  /// What crosses the line from its left side to its right side, looking from `from` to `to`, in
  /// the elements of this rank. `face_values`: along each face's normal, m3/s or m3; the result has
  /// their unit.
  [[nodiscard]] ExactSum across(const std::vector<double>& face_values) const;

 private:
  struct FaceWeight {
    int face;
    double weight;
  };
  std::vector<FaceWeight> weights_;  ///< of the sides of each own element
  double length_ = 0.0;
};

}  // namespace suffuse

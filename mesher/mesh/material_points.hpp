#pragma once

/// Material points of one phase, sorted by element.

#include "mesh/mesh.hpp"

namespace suffuse {

template <int Dim>
struct MaterialPoints {
  std::vector<int> element;                              ///< owner, ascending
  std::vector<std::array<double, Dim + 1>> barycentric;  ///< in the owner; sums to one
  std::vector<double> volume;                            ///< m3 (per metre of thickness in 2D)

  [[nodiscard]] int size() const { return static_cast<int>(element.size()); }
  [[nodiscard]] Vector<Dim> position(const Mesh<Dim>& mesh, int point) const {
    Vector<Dim> x = Vector<Dim>::Zero();
    for (int a = 0; a <= Dim; ++a) {
      x += barycentric[point][a] * mesh.nodes[mesh.elements[element[point]][a]];
    }
    return x;
  }
};

}  // namespace suffuse

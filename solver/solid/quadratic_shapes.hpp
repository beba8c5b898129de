#pragma once

/// Shape functions of quadratic displacements.

#include <array>
#include <map>
#include <vector>

#include "grid/grid.hpp"

namespace suffuse {

/// A node has the linear function N_a, an edge between the nodes a and b has 4 N_a N_b
/// (hierarchical functions: Zienkiewicz and Taylor, The Finite Element Method, 5th ed. (2000), vol.
/// 1, ch. 8). The value at a node is the displacement there. The value at an edge is the
/// displacement of its midpoint minus the mean of those of its two nodes. Nodes have the numbers of
/// the mesh; edges are numbered after them.
template <int Dim>
class QuadraticShapes {
 public:
  static constexpr int edges = Dim * (Dim + 1) / 2;
  static constexpr int count = Dim + 1 + edges;  ///< functions of an element
  using Gradients = Eigen::Matrix<double, Dim, count>;

  /// Keeps a reference.
  explicit QuadraticShapes(const Grid<Dim>& grid);

  /// Number of nodes and edges.
  [[nodiscard]] int size() const {
    return grid_.mesh.node_count() + static_cast<int>(ends_.size());
  }
  /// The functions of an element: its nodes, then its edges ab in the order a < b.
  [[nodiscard]] const std::array<int, count>& of_element(int element) const {
    return of_element_[element];
  }
  /// Number of the edge between two nodes. Throws std::out_of_range if there is none.
  [[nodiscard]] int edge_between(int a, int b) const;
  /// The nodes at the ends of an edge; twice the node of another number.
  [[nodiscard]] std::array<int, 2> ends(int number) const {
    const int nodes = grid_.mesh.node_count();
    return number < nodes ? std::array<int, 2>{number, number} : ends_[number - nodes];
  }
  /// Gradients of an element's functions at a place in barycentric coordinates, 1/m.
  [[nodiscard]] Gradients gradients(int element, const std::array<double, Dim + 1>& at) const;

 private:
  const Grid<Dim>& grid_;
  std::vector<std::array<int, count>> of_element_;
  std::vector<std::array<int, 2>> ends_;  ///< nodes of each edge, ascending
  std::map<std::array<int, 2>, int> number_;
};

}  // namespace suffuse

#pragma once

/// Forces on the functions of the displacement.

#include <memory>
#include <span>
#include <utility>

#include "solid/solid_points.hpp"
#include "solid/supports.hpp"

namespace suffuse {

/// Share of the forces at the ends of an edge that acts on the edge's own function 4 N_a N_b where
/// a load is the same all over an element or a face: the ratio of the integrals of 4 N_a N_b and of
/// N_a + N_b, or of their gradients.
template <int Dim>
struct EdgeShare {
  static constexpr double volume = 2.0 / (Dim + 2);  ///< of a force per volume
  static constexpr double face = 2.0 / (Dim + 1);    ///< of a traction
  static constexpr double stress = 4.0 / (Dim + 1);  ///< of a stress
};

/// Loads on linear displacements, which nodes have, or on quadratic ones, which edges have too.
template <int Dim>
class NodalLoads {
 public:
  /// Loads on linear displacements.
  explicit NodalLoads(const Grid<Dim>& grid)
      : grid_(grid), forces_(grid.mesh.node_count(), Vector<Dim>::Zero()) {}
  /// Loads on quadratic displacements.
  NodalLoads(const Grid<Dim>& grid, std::shared_ptr<const QuadraticShapes<Dim>> shapes)
      : grid_(grid), shapes_(std::move(shapes)), forces_(shapes_->size(), Vector<Dim>::Zero()) {}

  /// Adds a force at a place, N. Outside its element the functions are extrapolated.
  void add_at(const PointPlace<Dim>& place, const Vector<Dim>& force) {
    const auto& nodes = grid_.mesh.elements[place.element];
    for (int a = 0; a <= Dim; ++a) {
      forces_[nodes[a]] += place.barycentric[a] * force;
      for (int b = 0; b < a && shapes_; ++b) {
        forces_[shapes_->edge_between(nodes[a], nodes[b])] +=
            4.0 * place.barycentric[a] * place.barycentric[b] * force;
      }
    }
  }

  /// Adds the forces of a load that is the same all over an element or a face with these nodes.
  /// \param force      `force(k)` on the k-th node, N
  /// \param share      of `EdgeShare`
  /// \param is_loaded  per node: forces on other nodes, and on edges that end there, are left out
  void add(std::span<const int> nodes, const auto& force, double share,
           const std::vector<char>& is_loaded) {
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      if (is_loaded[nodes[a]] == 0) continue;
      const Vector<Dim> on_node = force(a);
      forces_[nodes[a]] += on_node;
      for (std::size_t b = 0; b < nodes.size() && shapes_; ++b) {
        if (b == a || is_loaded[nodes[b]] == 0) continue;
        forces_[shapes_->edge_between(nodes[a], nodes[b])] += share * on_node;
      }
    }
  }

  [[nodiscard]] const NodeVectors<Dim>& forces() const { return forces_; }
  [[nodiscard]] NodeVectors<Dim>& forces() { return forces_; }
  /// The functions of quadratic displacements; null for linear ones.
  [[nodiscard]] const std::shared_ptr<const QuadraticShapes<Dim>>& shapes() const {
    return shapes_;
  }
  /// No loads on the same displacements.
  [[nodiscard]] NodalLoads none() const {
    return shapes_ ? NodalLoads(grid_, shapes_) : NodalLoads(grid_);
  }

 private:
  const Grid<Dim>& grid_;
  std::shared_ptr<const QuadraticShapes<Dim>> shapes_;
  NodeVectors<Dim> forces_;
};

}  // namespace suffuse

#pragma once

/// A discontinuous linear field: Dim + 1 values per element, at the points of the quadrature rule
/// of degree two. At these points the linear basis is orthogonal, so every mass matrix is diagonal;
/// for triangles they are the three interior Gauss points, where three material points per element
/// lie.

#include <array>
#include <cmath>
#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

template <int Dim>
using ElementValues = std::array<double, Dim + 1>;

template <int Dim>
using ElementField = std::vector<ElementValues<Dim>>;

template <int Dim>
struct FieldNodes {
  /// Barycentric coordinates of field node j: `near_vertex` for vertex j, `far_vertex` for others.
  static constexpr double near_vertex = Dim == 2 ? 2.0 / 3.0 : 0.58541019662496845446;
  static constexpr double far_vertex = Dim == 2 ? 1.0 / 6.0 : 0.13819660112501051518;
  static constexpr double spread = near_vertex - far_vertex;

  /// Position of field node j of an element, m.
  static Vector<Dim> position(const Mesh<Dim>& mesh, int element, int j) {
    Vector<Dim> x = Vector<Dim>::Zero();
    for (int k = 0; k <= Dim; ++k) {
      x += (k == j ? near_vertex : far_vertex) * mesh.nodes[mesh.elements[element][k]];
    }
    return x;
  }

  /// Value of basis function j where the barycentric coordinate j is `coordinate`.
  static constexpr double basis(double coordinate) { return (coordinate - far_vertex) / spread; }

  /// The field's value at a place of the element.
  static double value(const ElementValues<Dim>& at_nodes,
                      const std::array<double, Dim + 1>& barycentric) {
    double sum = 0.0;
    for (int j = 0; j <= Dim; ++j) sum += at_nodes[j] * basis(barycentric[j]);
    return sum;
  }

  /// Values at the element's vertices.
  static ElementValues<Dim> at_vertices(const ElementValues<Dim>& at_nodes) {
    double sum = 0.0;
    for (const double v : at_nodes) sum += v;
    ElementValues<Dim> result;
    for (int k = 0; k <= Dim; ++k) result[k] = at_vertex(at_nodes[k], sum);
    return result;
  }
  /// The value at one vertex, from that at its node and the sum over all nodes.
  static constexpr double at_vertex(double at_node, double sum) {
    return (at_node - far_vertex * sum) / spread;
  }
};

/// Sum over an element's nodes.
template <int Dim>
double element_sum(const ElementValues<Dim>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum;
}

/// Sum over the nodes of each element.
template <int Dim>
std::vector<double> element_sums(const ElementField<Dim>& field) {
  std::vector<double> result;
  result.reserve(field.size());
  for (const ElementValues<Dim>& values : field) result.push_back(element_sum<Dim>(values));
  return result;
}

/// Adds to `room` the volume of air that has left each element between two states, m3. `room` may
/// be empty, and remains so without air.
template <std::size_t Sides>
void add_displaced_air(const std::vector<std::array<double, Sides>>& before,
                       const std::vector<std::array<double, Sides>>& after,
                       std::vector<double>& room) {
  if (room.empty()) room.resize(before.size(), 0.0);
  for (std::size_t e = 0; e < before.size(); ++e) {
    for (std::size_t k = 0; k < Sides; ++k) room[e] += before[e][k] - after[e][k];
  }
}

}  // namespace suffuse

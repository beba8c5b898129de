#pragma once

/// Supports of the soil, and the unknown displacements.

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "solid/quadratic_shapes.hpp"

namespace suffuse {

/// A vector per node of the mesh.
template <int Dim>
using NodeVectors = std::vector<Vector<Dim>>;

/// Euclidean norm of all components.
template <int Dim>
double norm(const NodeVectors<Dim>& vectors) {
  double sum = 0.0;
  for (const Vector<Dim>& v : vectors) sum += v.squaredNorm();
  return std::sqrt(sum);
}

/// How a face holds its nodes.
enum class Support : char { none, normal, both };

/// Directions in which each node is held, and each edge where displacements are quadratic.
template <int Dim>
class Supports {
 public:
  /// \param face_support  per face of the grid
  Supports(const Grid<Dim>& grid, const std::vector<Support>& face_support);

  /// These supports, and those of the edges on the same faces.
  [[nodiscard]] Supports with_edges(const Grid<Dim>& grid,
                                    const QuadraticShapes<Dim>& shapes) const;

  /// Holds a node in all directions.
  void hold(int node) { free_count_[node] = 0; }
  /// Holds the nodes of an element with a rigid skeleton; its faces do not move either.
  void hold_element(const Mesh<Dim>& mesh, int element);
  /// Per element: whether its skeleton is rigid. Empty: none is rigid.
  [[nodiscard]] const std::vector<char>& rigid_elements() const { return rigid_; }
  [[nodiscard]] bool is_rigid(int element) const { return !rigid_.empty() && rigid_[element] != 0; }

  /// Number of directions in which a node is free.
  [[nodiscard]] int free_count(int node) const { return free_count_[node]; }
  /// Orthonormal directions in columns, the free ones first.
  [[nodiscard]] const Eigen::Matrix<double, Dim, Dim>& directions(int node) const {
    return directions_[node];
  }
  /// Whether the soil cannot move through a face.
  [[nodiscard]] bool holds_normal(const Grid<Dim>& grid, int face) const;

 private:
  void hold_along(int number, const std::vector<Vector<Dim>>& normals);

  std::vector<Support> face_support_;
  std::vector<int> free_count_;
  std::vector<Eigen::Matrix<double, Dim, Dim>> directions_;
  std::vector<char> rigid_;
};

/// Numbers the unknown displacements: those of free directions of nodes in use.
template <int Dim>
class DisplacementUnknowns {
 public:
  /// \param used  per node; Supports are kept by reference
  DisplacementUnknowns(const Supports<Dim>& supports, const std::vector<char>& used);

  [[nodiscard]] int count() const { return count_; }
  /// First unknown of a node; the others of its free directions follow.
  [[nodiscard]] int first(int node) const { return first_[node]; }
  /// Number of unknowns of a node.
  [[nodiscard]] int count(int node) const { return count_of_[node]; }
  [[nodiscard]] const Supports<Dim>& supports() const { return supports_; }

  /// Components of nodal vectors along free directions.
  [[nodiscard]] Eigen::VectorXd components(const NodeVectors<Dim>& vectors) const;
  /// Adds `share` times the vectors that have these components.
  void add(const Eigen::VectorXd& components, double share, NodeVectors<Dim>& vectors) const;
  /// The vectors that have these components, and none along held directions.
  [[nodiscard]] NodeVectors<Dim> vectors(const Eigen::VectorXd& components) const;
  /// Node with the longest vector of these components.
  [[nodiscard]] int longest(const Eigen::VectorXd& components) const;

 private:
  const Supports<Dim>& supports_;
  std::vector<int> first_;
  std::vector<int> count_of_;
  int count_ = 0;
};

}  // namespace suffuse

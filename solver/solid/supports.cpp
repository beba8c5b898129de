#include "solid/supports.hpp"

#include <algorithm>
#include <cmath>

namespace suffuse {
namespace {

/// Faces of a boundary whose normals differ by less than 30 degrees form a curve, which holds a
/// node along their mean normal; otherwise they form a corner, which holds it along both.
const double cosine_of_corner = std::sqrt(0.75);

/// Adds the normal of one more face, times its area, to the normals of a node.
template <int Dim>
void add_normal(std::vector<Vector<Dim>>& normals, const Vector<Dim>& normal) {
  for (Vector<Dim>& known : normals) {
    if (known.dot(normal) > cosine_of_corner * known.norm() * normal.norm()) {
      known += normal;
      return;
    }
  }
  normals.push_back(normal);
}

/// Direction of the part of `v` that is normal to `count` orthonormal vectors; zero if that part is
/// small. Whatever the vectors, enough of the axes have a large such part.
template <int Dim>
Vector<Dim> direction_across(const Eigen::Matrix<double, Dim, Dim>& directions, int from, int count,
                             Vector<Dim> v) {
  const double length = v.norm();
  for (int k = from; k < from + count; ++k) v -= directions.col(k).dot(v) * directions.col(k);
  if (v.norm() < 0.1 * length) return Vector<Dim>::Zero();
  return v.normalized();
}

}  // namespace

template <int Dim>
Supports<Dim>::Supports(const Grid<Dim>& grid, const std::vector<Support>& face_support)
    : face_support_(face_support),
      free_count_(grid.mesh.node_count(), Dim),
      directions_(grid.mesh.node_count(), Eigen::Matrix<double, Dim, Dim>::Identity()) {
  std::vector<std::vector<Vector<Dim>>> normals(grid.mesh.node_count());
  for (int f = 0; f < grid.face_count(); ++f) {
    if (face_support[f] == Support::none) continue;
    for (const int i : grid.face_nodes[f]) {
      if (face_support[f] == Support::both) free_count_[i] = 0;
      add_normal<Dim>(normals[i], grid.face_normal[f]);
    }
  }
  for (int i = 0; i < grid.mesh.node_count(); ++i) hold_along(i, normals[i]);
}

template <int Dim>
Supports<Dim> Supports<Dim>::with_edges(const Grid<Dim>& grid,
                                        const QuadraticShapes<Dim>& shapes) const {
  Supports result = *this;
  result.free_count_.resize(shapes.size(), Dim);
  result.directions_.resize(shapes.size(), Eigen::Matrix<double, Dim, Dim>::Identity());
  std::vector<std::vector<Vector<Dim>>> normals(shapes.size());
  for (int f = 0; f < grid.face_count(); ++f) {
    if (face_support_[f] == Support::none) continue;
    for (int a = 0; a < Dim; ++a) {
      for (int b = a + 1; b < Dim; ++b) {
        const int i = shapes.edge_between(grid.face_nodes[f][a], grid.face_nodes[f][b]);
        if (face_support_[f] == Support::both) result.hold(i);
        add_normal<Dim>(normals[i], grid.face_normal[f]);
      }
    }
  }
  for (int i = grid.mesh.node_count(); i < shapes.size(); ++i) result.hold_along(i, normals[i]);
  for (std::size_t e = 0; e < rigid_.size(); ++e) {
    if (rigid_[e] == 0) continue;
    for (const int i : shapes.of_element(static_cast<int>(e))) result.hold(i);
  }
  return result;
}

/// Holds a node or an edge along these normals, if it is not held altogether.
template <int Dim>
void Supports<Dim>::hold_along(int number, const std::vector<Vector<Dim>>& normals) {
  if (normals.empty() || free_count_[number] == 0) return;
  auto& directions = directions_[number];
  int held = 0;  // these are the last columns
  for (const Vector<Dim>& normal : normals) {
    if (held == Dim) break;
    const Vector<Dim> next = direction_across<Dim>(directions, Dim - held, held, normal);
    if (next.isZero(0.0)) continue;
    directions.col(Dim - ++held) = next;
  }
  free_count_[number] = Dim - held;
  // Free directions: axes, made normal to held directions and to free ones found before.
  for (int axis = 0, found = 0; axis < Dim && found < Dim - held; ++axis) {
    Vector<Dim> next = direction_across<Dim>(directions, Dim - held, held, Vector<Dim>::Unit(axis));
    if (!next.isZero(0.0)) next = direction_across<Dim>(directions, 0, found, next);
    if (!next.isZero(0.0)) directions.col(found++) = next;
  }
}

template <int Dim>
void Supports<Dim>::hold_element(const Mesh<Dim>& mesh, int element) {
  rigid_.resize(mesh.element_count(), 0);
  rigid_[element] = 1;
  for (const int i : mesh.elements[element]) hold(i);
}

template <int Dim>
bool Supports<Dim>::holds_normal(const Grid<Dim>& grid, int face) const {
  const Vector<Dim> normal = grid.face_normal[face].normalized();
  return std::ranges::all_of(grid.face_nodes[face], [&](int node) {
    // Supports of curved faces have averaged normals at their nodes.
    return (directions_[node].leftCols(free_count_[node]).transpose() * normal).norm() <= 0.5;
  });
}

template <int Dim>
DisplacementUnknowns<Dim>::DisplacementUnknowns(const Supports<Dim>& supports,
                                                const std::vector<char>& used)
    : supports_(supports), first_(used.size(), -1), count_of_(used.size(), 0) {
  for (int i = 0; i < static_cast<int>(used.size()); ++i) {
    if (!used[i]) continue;
    first_[i] = count_;
    count_of_[i] = supports.free_count(i);
    count_ += count_of_[i];
  }
}

template <int Dim>
Eigen::VectorXd DisplacementUnknowns<Dim>::components(const NodeVectors<Dim>& vectors) const {
  Eigen::VectorXd result(count_);
  for (int i = 0; i < static_cast<int>(first_.size()); ++i) {
    for (int k = 0; k < count_of_[i]; ++k) {
      result[first_[i] + k] = supports_.directions(i).col(k).dot(vectors[i]);
    }
  }
  return result;
}

template <int Dim>
void DisplacementUnknowns<Dim>::add(const Eigen::VectorXd& components, double share,
                                    NodeVectors<Dim>& vectors) const {
  for (int i = 0; i < static_cast<int>(first_.size()); ++i) {
    for (int k = 0; k < count_of_[i]; ++k) {
      vectors[i] += share * components[first_[i] + k] * supports_.directions(i).col(k);
    }
  }
}

template class Supports<2>;
template class Supports<3>;
template <int Dim>
NodeVectors<Dim> DisplacementUnknowns<Dim>::vectors(const Eigen::VectorXd& components) const {
  NodeVectors<Dim> result(first_.size(), Vector<Dim>::Zero());
  add(components, 1.0, result);
  return result;
}

template <int Dim>
int DisplacementUnknowns<Dim>::longest(const Eigen::VectorXd& components) const {
  const NodeVectors<Dim> vectors = this->vectors(components);
  const auto shorter = [](const Vector<Dim>& a, const Vector<Dim>& b) {
    return a.squaredNorm() < b.squaredNorm();
  };
  return static_cast<int>(std::ranges::max_element(vectors, shorter) - vectors.begin());
}

template class DisplacementUnknowns<2>;
template class DisplacementUnknowns<3>;

}  // namespace suffuse

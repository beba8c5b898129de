#include "mesh/mesh.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace suffuse {
namespace {

/// The edges from the first vertex to the others, one in a column.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> edge_matrix(const Mesh<Dim>& mesh, int element) {
  const auto& corners = mesh.elements[element];
  Eigen::Matrix<double, Dim, Dim> edges;
  for (int d = 0; d < Dim; ++d) {
    edges.col(d) = mesh.nodes[corners[d + 1]] - mesh.nodes[corners[0]];
  }
  return edges;
}

}  // namespace

template <int Dim>
double element_volume(const Mesh<Dim>& mesh, int element) {
  constexpr double factorial = Dim == 2 ? 2.0 : 6.0;
  return edge_matrix(mesh, element).determinant() / factorial;
}

template <int Dim>
double mean_size(const Mesh<Dim>& mesh) {
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) volume += element_volume(mesh, e);
  return std::pow(volume / mesh.element_count(), 1.0 / Dim);
}

template <int Dim>
Vector<Dim> element_centroid(const Mesh<Dim>& mesh, int element) {
  Vector<Dim> sum = Vector<Dim>::Zero();
  for (int node : mesh.elements[element]) sum += mesh.nodes[node];
  return sum / (Dim + 1);
}

template <int Dim>
std::array<double, Dim + 1> barycentric(const Mesh<Dim>& mesh, int element, const Vector<Dim>& x) {
  Eigen::Matrix<double, Dim + 1, Dim> gradients;
  gradients.template bottomRows<Dim>() = edge_matrix(mesh, element).inverse();
  gradients.row(0) = -gradients.template bottomRows<Dim>().colwise().sum();
  std::array<double, Dim + 1> result;
  for (int k = 0; k <= Dim; ++k) {
    // Coordinate k is 0 at the vertex after k.
    const Vector<Dim>& foot = mesh.nodes[mesh.elements[element][(k + 1) % (Dim + 1)]];
    result[k] = gradients.row(k).dot(x - foot);
  }
  return result;
}

template <int Dim>
double largest_coordinate(const Mesh<Dim>& mesh) {
  double largest = 0.0;
  for (const Vector<Dim>& x : mesh.nodes) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  return largest;
}

template <int Dim>
Vector<Dim> extent(const Mesh<Dim>& mesh) {
  Vector<Dim> low = mesh.nodes.front();
  Vector<Dim> high = low;
  for (const Vector<Dim>& x : mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return high - low;
}

template <>
double smallest_angle(const Mesh<2>& mesh) {
  double smallest = std::numbers::pi;
  for (const auto& corners : mesh.elements) {
    for (int a = 0; a < 3; ++a) {
      const Vector<2> u = mesh.nodes[corners[(a + 1) % 3]] - mesh.nodes[corners[a]];
      const Vector<2> v = mesh.nodes[corners[(a + 2) % 3]] - mesh.nodes[corners[a]];
      const double cross = u.x() * v.y() - u.y() * v.x();
      smallest = std::min(smallest, std::atan2(std::abs(cross), u.dot(v)));
    }
  }
  return smallest * 180.0 / std::numbers::pi;
}

template <>
double smallest_angle(const Mesh<3>& mesh) {
  double smallest = std::numbers::pi;
  for (const auto& corners : mesh.elements) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < a; ++b) {
        // Finds the angle between the two faces at the edge from a to b.
        const Vector<3>& start = mesh.nodes[corners[a]];
        const Vector<3> along = (mesh.nodes[corners[b]] - start).normalized();
        std::array<Vector<3>, 2> aside;
        int count = 0;
        for (int c = 0; c < 4; ++c) {
          if (c == a || c == b) continue;
          const Vector<3> offset = mesh.nodes[corners[c]] - start;
          aside[count++] = offset - offset.dot(along) * along;
        }
        const double cross = aside[0].cross(aside[1]).norm();
        smallest = std::min(smallest, std::atan2(cross, aside[0].dot(aside[1])));
      }
    }
  }
  return smallest * 180.0 / std::numbers::pi;
}

template double element_volume<2>(const Mesh<2>&, int);
template double element_volume<3>(const Mesh<3>&, int);
template double mean_size(const Mesh<2>&);
template double mean_size(const Mesh<3>&);
template Vector<2> element_centroid<2>(const Mesh<2>&, int);
template Vector<3> element_centroid<3>(const Mesh<3>&, int);
template std::array<double, 3> barycentric<2>(const Mesh<2>&, int, const Vector<2>&);
template std::array<double, 4> barycentric<3>(const Mesh<3>&, int, const Vector<3>&);
template double largest_coordinate(const Mesh<2>&);
template double largest_coordinate(const Mesh<3>&);
template Vector<2> extent<2>(const Mesh<2>&);
template Vector<3> extent<3>(const Mesh<3>&);

}  // namespace suffuse

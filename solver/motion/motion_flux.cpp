#include "motion/motion_flux.hpp"

#include <Eigen/Geometry>

namespace suffuse {
namespace {

template <int Dim>
using Corners = std::array<Vector<Dim>, Dim>;

/// Normal of a face times its area, of either sign.
Vector<2> normal_of(const Corners<2>& x) {
  const Vector<2> along = x[1] - x[0];
  return {along[1], -along[0]};
}
Vector<3> normal_of(const Corners<3>& x) {
  return 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
}

/// The mean of the normal while the corners move by `u`. The normal is linear in the motion in two
/// dimensions, and quadratic in three, for which Simpson's rule is exact.
template <int Dim>
Vector<Dim> mean_normal(const Corners<Dim>& x, const Corners<Dim>& u) {
  const auto normal_at = [&](double share) {
    Corners<Dim> moved;
    for (int k = 0; k < Dim; ++k) moved[k] = x[k] + share * u[k];
    return normal_of(moved);
  };
  Vector<Dim> middle = normal_at(0.5);
  if (Dim == 2) return middle;
  return (normal_at(0.0) + 4.0 * middle + normal_at(1.0)) / 6.0;
}

/// Integral over an element of grad b grad b^T for the bubble b of the face opposite its local
/// vertex `k`: b = 4 N_1 N_2 in two dimensions, 27 N_1 N_2 N_3 in three.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> bubble_gradients(const Grid<Dim>& grid, int e, int k) {
  constexpr double same = Dim == 2 ? 16.0 / 6.0 : 729.0 / 210.0;
  Eigen::Matrix<double, Dim, Dim> sum = Eigen::Matrix<double, Dim, Dim>::Zero();
  for (int a = 0; a <= Dim; ++a) {
    for (int b = 0; b <= Dim; ++b) {
      if (a == k || b == k) continue;
      const Vector<Dim>& first = grid.shape_gradient[e][a];
      const Vector<Dim>& second = grid.shape_gradient[e][b];
      sum += (a == b ? same : 0.5 * same) * grid.volume[e] * first * second.transpose();
    }
  }
  return sum;
}

}  // namespace

template <int Dim>
std::vector<double> swept_volumes(const Grid<Dim>& grid, const PointsByElement& sorted,
                                  const NodeVectors<Dim>& displacement) {
  std::vector<double> result(grid.face_count(), 0.0);
  for (int f = 0; f < grid.face_count(); ++f) {
    const int right = grid.face_right[f];
    if (sorted.is_empty(grid.face_left[f]) && (right < 0 || sorted.is_empty(right))) continue;
    Corners<Dim> x;
    Corners<Dim> u;
    Vector<Dim> mean = Vector<Dim>::Zero();
    for (int k = 0; k < Dim; ++k) {
      x[k] = grid.mesh.nodes[grid.face_nodes[f][k]];
      u[k] = displacement[grid.face_nodes[f][k]];
      mean += u[k] / Dim;
    }
    const double side = normal_of(x).dot(grid.face_normal[f]) > 0.0 ? 1.0 : -1.0;
    result[f] = side * mean_normal<Dim>(x, u).dot(mean);
  }
  return result;
}

template <int Dim>
FaceBubbles<Dim>::FaceBubbles(const Grid<Dim>& grid, const StepEquilibrium<Dim>& step,
                              const std::vector<double>& inertia)
    : grid_(grid), step_(step), softness_(grid.face_count(), 0.0) {
  constexpr double mean_of_bubble = Dim == 2 ? 2.0 / 3.0 : 9.0 / 20.0;     // over its face
  constexpr double mean_of_square = Dim == 2 ? 8.0 / 45.0 : 27.0 / 280.0;  // over an element
  const Supports<Dim>& supports = step.equilibrium().unknowns().supports();
  for (int f = 0; f < grid.face_count(); ++f) {
    if (grid.is_outer(f)) continue;
    if (supports.is_rigid(grid.face_left[f]) || supports.is_rigid(grid.face_right[f])) continue;
    const double area = grid.face_normal[f].norm();
    const Vector<Dim> n = grid.face_normal[f] / area;
    double stiffness = 0.0;
    bool soil_on_both = true;
    for (const int e : {grid.face_left[f], grid.face_right[f]}) {
      if (step.sorted().is_empty(e)) {
        soil_on_both = false;
        break;
      }
      const auto moduli = step.equilibrium().mean_moduli(e);
      const auto gradients = bubble_gradients(grid, e, grid.side_of(e, f));
      const double along = n.dot(gradients * n);
      stiffness += moduli.shear * (gradients.trace() + along) + moduli.lame * along;
      if (!inertia.empty()) stiffness += mean_of_square * inertia[e];
    }
    if (!soil_on_both) continue;
    const double moment = mean_of_bubble * area;
    softness_[f] = moment * moment / stiffness;
  }
}

template <int Dim>
void FaceBubbles<Dim>::add(const std::vector<double>& pressure_change,
                           std::vector<double>& face_volume) const {
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (softness_[f] == 0.0) continue;
    const Vector<Dim> n = grid_.face_normal[f].normalized();
    const auto change = [&](int e) {
      const Eigen::Matrix<double, Dim, Dim> stress =
          step_.equilibrium().mean_stress(e) - step_.start_stress()[e];
      return n.dot(stress * n) - pressure_change[e];
    };
    face_volume[f] -= softness_[f] * (change(grid_.face_left[f]) - change(grid_.face_right[f]));
  }
}

template std::vector<double> swept_volumes(const Grid<2>&, const PointsByElement&,
                                           const NodeVectors<2>&);
template std::vector<double> swept_volumes(const Grid<3>&, const PointsByElement&,
                                           const NodeVectors<3>&);
template class FaceBubbles<2>;
template class FaceBubbles<3>;

}  // namespace suffuse

#pragma once

/// Velocities of solid points, and their transfer to the nodes and back: affine (TPIC, Nakamura,
/// Matsumura and Mizutani, Comput. Methods Appl. Mech. Eng. 409 (2023)), limited.

#include <vector>

#include "solid/solid_points.hpp"
#include "solid/supports.hpp"

namespace suffuse {

/// Mass and velocity of the nodes.
template <int Dim>
struct NodalMotion {
  std::vector<double> mass;   ///< kg; 0 if no point is near
  NodeVectors<Dim> velocity;  ///< m/s
};

/// Velocity at the place of a point, and its gradient. Extrapolation to the nodes keeps the
/// momentum of the point. One factor per point scales the gradient so that extrapolated velocities
/// stay within those of the point and of the nodes of its element after the last step: otherwise a
/// point that has entered another element would throw its surface forward.
template <int Dim>
class PointVelocities {
 public:
  using Gradient = Eigen::Matrix<double, Dim, Dim>;

  PointVelocities() = default;
  /// Points at rest.
  explicit PointVelocities(int count)
      : velocity_(count, Vector<Dim>::Zero()), gradient_(count, Gradient::Zero()) {}

  /// Sets the velocity of a point and its gradient, before the first step.
  void set(int point, const Vector<Dim>& velocity, const Gradient& gradient) {
    velocity_[point] = velocity;
    gradient_[point] = gradient;
  }
  [[nodiscard]] const Vector<Dim>& velocity(int point) const { return velocity_[point]; }
  [[nodiscard]] bool empty() const { return velocity_.empty(); }
  /// Reorders the points: point order[k] becomes point k.
  void reorder(const std::vector<int>& order);

  /// \param mass  per point, kg
  [[nodiscard]] NodalMotion<Dim> to_nodes(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                          const std::vector<double>& mass) const;
  /// Sets velocities and gradients from the nodes at the end of a step.
  /// \param points    before they move
  /// \param velocity  per node, m/s; not used where `mass`, per node, is 0
  void take(const Grid<Dim>& grid, const SolidPoints<Dim>& points, NodeVectors<Dim> velocity,
            const std::vector<double>& mass);

  /// 1/2 sum m v^2, J (per meter of thickness in 2D).
  [[nodiscard]] double kinetic_energy(const std::vector<double>& mass) const;

  void archive(auto& archive) { archive(velocity_, gradient_, of_nodes_, in_use_); }

 private:
  [[nodiscard]] double limit(const Grid<Dim>& grid, int element, int point,
                             const Vector<Dim>& place) const;

  std::vector<Vector<Dim>> velocity_;  ///< per point, m/s
  std::vector<Gradient> gradient_;     ///< per point, 1/s
  NodeVectors<Dim> of_nodes_;          ///< after the last step, m/s; empty before the first
  std::vector<char> in_use_;           ///< per node: whether it had a mass in the last step
};

}  // namespace suffuse

#pragma once

/// Velocities of soil that has lost its equilibrium: from then on each step is an equilibrium with
/// the forces of inertia (backward Euler), until the soil has come to rest (docs/theory.md,
/// "Inertia of the soil").

#include "equilibrium/equilibrium.hpp"
#include "equilibrium/point_velocities.hpp"

namespace suffuse {

/// What the motion of soil is compared with.
struct SoilExtent {
  double mass = 0.0;    ///< kg
  double load = 0.0;    ///< its weight, or the loads of all nodes where there is no gravity, N
  double height = 0.0;  ///< along gravity, m

  /// Time in which its loads would move it by its height, s.
  [[nodiscard]] double time_of_fall() const;
};

/// How soil moved in a step.
struct SoilKinetics {
  double energy = 0.0;         ///< J
  double inertia_share = 0.0;  ///< of the forces of inertia in the loads
  SoilExtent soil = {};

  /// Whether soil moves so little that it can be in equilibrium: inertia carries less than 1 % of
  /// the loads, and the kinetic energy is less than 1e-6 of the loads times the height.
  [[nodiscard]] bool is_rest() const;
  /// Whether soil in equilibrium moves so fast that inertia decides how far it goes: the kinetic
  /// energy is more than 1e-4 of the loads times the height.
  [[nodiscard]] bool is_slide() const;
};

template <int Dim>
class SoilInertia {
 public:
  /// A step may take points through this share of the height of their element, at the velocity at
  /// its start.
  static constexpr double max_travel = 0.25;

  /// Whether inertia counts now.
  [[nodiscard]] bool acts() const { return !velocities_.empty(); }
  /// From now on it does; the soil was at rest.
  void begin(int point_count);
  /// Longest step from now on, s.
  [[nodiscard]] double longest_step() const;

  /// Mass and velocity of the nodes.
  /// \param mass  per point, kg
  [[nodiscard]] NodalMotion<Dim> nodes(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                       const std::vector<double>& mass) const {
    return velocities_.to_nodes(grid, points, mass);
  }

  /// Points take the velocities of a step that is over. Returns their kinetic energy, J.
  /// \param points  before they move
  /// \param nodes   at the start of the step
  /// \param mass    per point, kg
  /// \param share   of the forces of inertia in the loads
  double take(const Grid<Dim>& grid, const SolidPoints<Dim>& points, const NodalMotion<Dim>& nodes,
              const NodeVectors<Dim>& displacement, const std::vector<double>& mass,
              double duration, double travel, double share);

  /// Forces of inertia over the loads in the last step; 0 where it does not act.
  [[nodiscard]] double share() const { return share_; }
  /// The points have another order: the one that was at order[k] comes to k.
  void reorder(const std::vector<int>& order) { velocities_.reorder(order); }

  void archive(auto& archive) { archive(velocities_, rate_, share_); }

 private:
  PointVelocities<Dim> velocities_;  ///< of no points while inertia does not act
  double rate_ = 0.0;                ///< of travel over the heights of elements, 1/s
  double share_ = 0.0;               ///< see `share`
};

}  // namespace suffuse

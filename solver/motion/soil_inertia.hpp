#pragma once

/// Inertia of soil that has lost its equilibrium: from then on each step is an equilibrium with the
/// forces of inertia (backward Euler), until the soil has come to rest (docs/theory.md, "Inertia of
/// the soil").

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

template <int Dim>
class SoilInertia {
 public:
  /// A step may take points through this share of the height of their element, at the velocity at
  /// its start.
  static constexpr double max_travel = 0.25;

  /// Whether inertia counts now.
  [[nodiscard]] bool acts() const { return !velocities_.empty(); }
  /// The soil, which was at rest, has lost its equilibrium.
  void begin(int point_count);
  /// Longest step from now on, s.
  [[nodiscard]] double longest_step() const;

  /// Velocities go to the nodes, for the tries of a step.
  /// \param mass  per point, kg
  void start_step(const Grid<Dim>& grid, const SolidPoints<Dim>& points, std::vector<double> mass);
  /// Mass and velocity of the nodes at the start of the step.
  [[nodiscard]] const NodalMotion<Dim>& nodes() const { return nodes_; }

  /// The step is over: points take its velocities. Ends where the soil has been at rest for the
  /// time in which its loads would have moved it by its height.
  /// \param points  before they move
  /// \param share   of the forces of inertia in the loads
  void finish_step(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                   const NodeVectors<Dim>& displacement, double duration, double travel,
                   double share, const SoilExtent& extent);

  /// Forces of inertia over the loads in the last step; 0 where it does not act.
  [[nodiscard]] double share() const { return share_; }
  /// The points have another order: the one that was at order[k] comes to k.
  void reorder(const std::vector<int>& order) { velocities_.reorder(order); }

  void archive(auto& archive) { archive(velocities_, rate_, share_, rested_); }

 private:
  void end();

  PointVelocities<Dim> velocities_;  ///< of no points while inertia does not act
  std::vector<double> mass_;         ///< per point, kg
  NodalMotion<Dim> nodes_;
  double rate_ = 0.0;    ///< of travel over the heights of elements, 1/s
  double share_ = 0.0;   ///< see `share`
  double rested_ = 0.0;  ///< for so long the soil has been at rest, s
};

/// Whether soil moves so little that it can be in equilibrium: inertia carries less than 1 % of the
/// loads, and the kinetic energy, J, is less than 1e-6 of the loads times the height.
[[nodiscard]] bool is_at_rest(double inertia_share, double kinetic_energy,
                              const SoilExtent& extent);

/// Whether soil in equilibrium moves so fast that inertia decides how far it goes: the kinetic
/// energy, J, is more than 1e-4 of the loads times the height.
[[nodiscard]] bool is_sliding(double kinetic_energy, const SoilExtent& extent);

}  // namespace suffuse

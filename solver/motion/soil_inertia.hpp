#pragma once

/// Velocities of soil that has lost its equilibrium. Until the soil comes to rest, each step is an
/// equilibrium with the forces of inertia (backward Euler; docs/theory/moving-soil.md, "Inertia of
/// the soil").

#include "equilibrium/equilibrium.hpp"
#include "equilibrium/point_velocities.hpp"
#include "equilibrium/soil_kinetics.hpp"

namespace suffuse {

template <int Dim>
class SoilInertia {
 public:
  /// Longest way of a point in a step, over the height of its element, at its velocity at the
  /// start.
  static constexpr double max_travel = 0.25;

  /// Whether the soil has inertia now.
  [[nodiscard]] bool acts() const { return !velocities_.empty(); }
  /// Starts inertia; the soil was at rest.
  void begin(int point_count);
  /// Longest next step, s.
  [[nodiscard]] double longest_step() const;

  /// Mass and velocity of the nodes.
  /// \param mass  per point, kg
  [[nodiscard]] NodalMotion<Dim> nodes(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                       const std::vector<double>& mass) const {
    return velocities_.to_nodes(grid, points, mass);
  }

  /// Sets the velocities of points to those of a finished step. Returns their kinetic energy, J.
  /// \param points  before they move
  /// \param nodes   at the start of the step
  /// \param mass    per point, kg
  /// \param share   of the forces of inertia in the loads
  double take(const Grid<Dim>& grid, const SolidPoints<Dim>& points, const NodalMotion<Dim>& nodes,
              const NodeVectors<Dim>& displacement, const std::vector<double>& mass,
              double duration, double travel, double share);
  /// Way of each point since inertia started, m.
  [[nodiscard]] const std::vector<double>& way() const { return way_; }
  /// Forces of inertia over the loads in the last step; 0 without inertia.
  [[nodiscard]] double share() const { return share_; }
  /// Reorders the points: point order[k] becomes point k.
  void reorder(const std::vector<int>& order) {
    velocities_.reorder(order);
    suffuse::reorder(order, way_);
  }

  void archive(auto& archive) { archive(velocities_, way_, rate_, share_); }

 private:
  PointVelocities<Dim> velocities_;  ///< empty without inertia
  std::vector<double> way_;          ///< see `way`
  double rate_ = 0.0;                ///< travel over the heights of elements per time, 1/s
  double share_ = 0.0;               ///< see `share`
};

}  // namespace suffuse

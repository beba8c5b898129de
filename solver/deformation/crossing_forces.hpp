#pragma once

/// What points put out of balance as they go from element to element.

#include "deformation/equilibrium.hpp"

namespace suffuse {

/// When a point comes into another element, the forces of its stress on the nodes change at once,
/// though the soil has not changed: the crossing error of the material point method. If the next
/// step balanced it, it would move the soil by a finite distance however short it is, and the
/// water, which cannot leave in so short a time, would bear the difference. The difference is a
/// force of its own instead: it keeps the balance after each motion and fades while water leaves
/// the elements around (docs/theory.md, "Points cross elements").
template <int Dim>
class CrossingForces {
 public:
  /// Finds the forces after points have moved.
  /// \param moved        the moved points at rest, with the pore pressure at the end of the step
  /// \param loads        per node, at the end of the step, N
  /// \param diffusivity  c_v = k E_oed/gamma_w per element, m2/s; not used where there is no soil
  void find(const Grid<Dim>& grid, const PointsByElement& sorted, const Equilibrium<Dim>& moved,
            const NodeVectors<Dim>& loads, const std::vector<double>& diffusivity);
  /// Adds what is left of them so long, s, after they were found.
  void add(double duration, NodeVectors<Dim>& loads) const;

  void archive(auto& archive) { archive(force_, fading_); }

  /// The forces fade in this many times h^2/c_v, h: height of an element. Large strain of a column
  /// of 32 rows, largest error of the settlement over its height and of the pressure over the load:
  /// 0.7 % and 1.7 % with 1, 0.5 % and 0.6 % with 20, 0.2 % and 2.2 % with 100.
  static constexpr double drainage_times = 20.0;

 private:
  NodeVectors<Dim> force_;      ///< N; empty: none
  std::vector<double> fading_;  ///< rate at which each fades, 1/s
};

}  // namespace suffuse

#pragma once

/// What points put out of balance as they go from element to element.

#include "equilibrium/equilibrium.hpp"

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

  /// The forces fade in this many times h^2/c_v, h: height of an element. With 20 errors do not
  /// fall with the mesh, and a surface whose pores close is pressed shut; with 0.1 it loses its
  /// equilibrium (docs/theory.md).
  static constexpr double drainage_times = 1.0;

 private:
  NodeVectors<Dim> force_;      ///< N; empty: none
  std::vector<double> fading_;  ///< rate at which each fades, 1/s
};

}  // namespace suffuse

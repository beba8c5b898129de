#pragma once

/// Forces out of balance because points have changed elements.

#include <algorithm>
#include <utility>

#include "equilibrium/equilibrium.hpp"

namespace suffuse {

/// When a point enters another element, the nodal forces of its stress change at once, though the
/// soil does not: the crossing error of the material point method. If the next step balanced it,
/// the soil would move by a finite distance however short the step, and water, which cannot leave
/// in so short a time, would carry the difference. Instead, the difference is a force that keeps
/// the balance after each motion and fades while water leaves the elements around
/// (docs/theory/moving-soil.md, "Points cross elements").
template <int Dim>
class CrossingForces {
 public:
  /// Finds the forces after points have moved.
  /// \param moved        the moved points at rest, with the pore pressure at the end of the step
  /// \param loads        per node, at the end of the step, N
  /// \param diffusivity  c_v = k E_oed/gamma_w per element, m2/s; not used where there is no soil
  void find(const Grid<Dim>& grid, const PointsByElement& sorted, const Equilibrium<Dim>& moved,
            const NodeVectors<Dim>& loads, const std::vector<double>& diffusivity);
  [[nodiscard]] bool empty() const { return force_.empty(); }
  /// The forces, N; none are left.
  [[nodiscard]] NodeVectors<Dim> take() { return std::exchange(force_, {}); }
  /// Keeps the forces as they are: they do not fade.
  void keep() { std::ranges::fill(fading_, 0.0); }
  /// Adds the forces that remain after `duration`, s.
  void add(double duration, NodeVectors<Dim>& loads) const;
  /// Soft stiffness in a step without inertia. That against the strain fades, too, as drained soil
  /// would settle late.
  [[nodiscard]] SoftStiffness soft_stiffness(double duration) const;

  void archive(auto& archive) { archive(force_, fading_); }

  /// The forces fade in this many times h^2/c_v, h: height of an element. With 20, errors do not
  /// fall with the mesh, and a surface whose pores close is pressed shut; with 0.1, it loses its
  /// equilibrium (docs/theory/moving-soil.md).
  static constexpr double drainage_times = 1.0;

 private:
  NodeVectors<Dim> force_;      ///< N; empty: none
  std::vector<double> fading_;  ///< rate of fading per node, 1/s
};

}  // namespace suffuse

#pragma once

/// Forces of the solid as functions of a displacement: what Newton's method and pseudo-time need.

#include <Eigen/SparseCore>
#include <memory>

#include "solid/stiffness_pattern.hpp"

namespace suffuse {

/// Vectors have a value per node, and per edge where displacements are quadratic.
template <int Dim>
class ForceBalance {
 public:
  using Pattern = std::shared_ptr<const StiffnessPattern<Dim>>;
  static constexpr double least_strain = 1e-4;

  ForceBalance() = default;
  ForceBalance(const ForceBalance&) = delete;
  ForceBalance& operator=(const ForceBalance&) = delete;
  virtual ~ForceBalance() = default;

  [[nodiscard]] virtual const DisplacementUnknowns<Dim>& unknowns() const = 0;
  /// Whether the forces at a displacement, m, can be found.
  [[nodiscard]] virtual bool is_possible(const NodeVectors<Dim>& displacement) const = 0;
  /// Sets the displacement over the step, m, which must be possible. Tangents cost more than
  /// forces; `assemble` needs them. The last displacement costs nothing.
  virtual void displace(const NodeVectors<Dim>& displacement, bool with_tangents) = 0;
  /// Finds the tangents at the last displacement.
  virtual void find_tangents() = 0;
  /// Forces of the solid and its pore water, N.
  [[nodiscard]] virtual NodeVectors<Dim> forces() const = 0;
  /// Norm of the forces of all elements, balanced or not, plus that at a strain of
  /// `least_strain`, N. Residuals are relative to it, also without stress.
  [[nodiscard]] virtual double force_scale() const = 0;
  [[nodiscard]] virtual bool has_inertia() const = 0;
  /// Takes this pattern of matrices if it is that of this body, otherwise sets it to that. Returns
  /// whether it was taken.
  virtual bool share_pattern(Pattern& pattern) = 0;
  /// Sets the derivative of the forces by the unknowns, N/m. Its pattern is always the same.
  virtual void assemble(Eigen::SparseMatrix<double>& tangent) = 0;
  /// The elastic stiffness of this body without stress. It is symmetric and, where the soil is
  /// held, positive definite, so that its factor serves as a preconditioner.
  virtual void assemble_elastic(Eigen::SparseMatrix<double>& stiffness) = 0;
};

}  // namespace suffuse

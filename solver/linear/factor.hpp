#pragma once

/// Something that a matrix is given to once and that then solves with it, again and again: the seam
/// behind which a direct factor stands or multigrid, and later a distributed library can.

#include <Eigen/SparseCore>

namespace suffuse {

/// Solves with a symmetric positive definite matrix. The same matrix and right-hand side give the
/// same bits, whatever was factored before and on any number of threads: a resumed run makes the
/// factor again, from the values of the matrix.
class Factor {
 public:
  Factor() = default;
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;
  virtual ~Factor() = default;

  /// Prepares for a matrix, of which both triangles are stored. Every call gets the same pattern.
  /// Throws NumericalError when the matrix is not positive definite or not finite; until a later
  /// call succeeds there is nothing to solve with.
  virtual void factorise(const Eigen::SparseMatrix<double>& matrix) = 0;

  /// Sets x to matrix^-1 rhs, with the matrix that was factored last, or near it. The operator that
  /// takes rhs to x is symmetric positive definite, as preconditioned conjugate gradients need it;
  /// where it is not exact, nearly so.
  virtual void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) = 0;

  /// Whether `solve` gives the solution up to round-off.
  [[nodiscard]] virtual bool is_exact() const { return true; }
};

}  // namespace suffuse

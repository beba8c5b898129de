#pragma once

/// Interface of solvers that prepare for a matrix once and then solve with it repeatedly: a direct
/// factor or multigrid, and possibly a distributed library later.

#include <Eigen/SparseCore>

namespace suffuse {

/// Solves with a symmetric positive definite matrix. Equal matrices and right-hand sides give equal
/// bits, whatever was factored before and on any number of threads, as a resumed run makes the
/// factor again from the values of the matrix.
class Factor {
 public:
  Factor() = default;
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;
  virtual ~Factor() = default;

  /// Prepares for a matrix, of which both triangles are stored, with one pattern in all calls.
  /// Throws NumericalError if the matrix is not positive definite or not finite; there is nothing
  /// to solve with then until a later call succeeds.
  virtual void factorise(const Eigen::SparseMatrix<double>& matrix) = 0;

  /// Sets x to matrix^-1 rhs, or near it, with the matrix that was factored last. The map from rhs
  /// to x is symmetric positive definite, as preconditioned conjugate gradients need it; nearly so
  /// if it is not exact.
  virtual void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) = 0;

  /// Whether `solve` gives the solution up to round-off.
  [[nodiscard]] virtual bool is_exact() const { return true; }
};

}  // namespace suffuse

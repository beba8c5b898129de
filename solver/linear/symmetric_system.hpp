#pragma once

/// A linear system, and the residual of an approximate solution with its limit.

#include <Eigen/SparseCore>

namespace suffuse {

/// matrix x = rhs, with a symmetric positive definite matrix of which both triangles are stored.
/// Keeps references.
struct SymmetricSystem {
  const Eigen::SparseMatrix<double>& matrix;
  const Eigen::VectorXd& rhs;
  const Eigen::VectorXd& guess;  ///< initial guess of iterations
  const Eigen::VectorXd&
      tolerance;  ///< largest residual per row, in the unit of `rhs`; may be zero
};

/// product = matrix x, row by row: the same bits on any number of threads.
void multiply(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& x, int threads,
              Eigen::VectorXd& product);

/// Residual of the system per row, and the residual allowed.
class Residual {
 public:
  explicit Residual(int threads) : threads_(threads) {}

  /// Computes the residual of `x`, and that allowed: `tolerance` plus the round-off of computing a
  /// row, whose terms are as large as its diagonal times the largest unknown.
  void compute(const SymmetricSystem& system, const Eigen::VectorXd& x);

  /// Largest ratio of a row's residual to that allowed; infinite if a residual is NaN, or not zero
  /// where zero is allowed.
  [[nodiscard]] double excess() const;

  [[nodiscard]] bool is_allowed() const { return excess() <= 1.0; }

  Eigen::VectorXd values;  ///< right-hand side minus matrix times x; iterations update it

 private:
  int threads_;
  Eigen::VectorXd allowed_;
};

}  // namespace suffuse

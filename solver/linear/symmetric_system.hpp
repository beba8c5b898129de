#pragma once

/// A linear system as it is handed over to be solved, and how far an approximate solution is from
/// solving it.

#include <Eigen/SparseCore>

namespace suffuse {

/// matrix x = rhs, with a symmetric positive definite matrix of which both triangles are stored.
/// Refers to what the caller keeps.
struct SymmetricSystem {
  const Eigen::SparseMatrix<double>& matrix;
  const Eigen::VectorXd& rhs;
  const Eigen::VectorXd& guess;  ///< where iterations start
  const Eigen::VectorXd&
      tolerance;  ///< largest residual per row, in the unit of `rhs`; may be zero
};

/// product = matrix x, row by row: the same bits on any number of threads.
void multiply(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& x, int threads,
              Eigen::VectorXd& product);

/// What is left of the right-hand side, per row, and how much of it may be left.
class Residual {
 public:
  explicit Residual(int threads) : threads_(threads) {}

  /// Residual of `x`, and what is allowed there: `tolerance` or the round-off of computing a row,
  /// whose terms are as large as its diagonal times the largest unknown.
  void compute(const SymmetricSystem& system, const Eigen::VectorXd& x);

  /// Largest ratio of a row's residual to what it is allowed; infinite where a residual is not a
  /// number, or where nothing is allowed and something left.
  [[nodiscard]] double excess() const;

  [[nodiscard]] bool is_allowed() const { return excess() <= 1.0; }

  Eigen::VectorXd values;  ///< right-hand side minus matrix times x; iterations update it

 private:
  int threads_;
  Eigen::VectorXd allowed_;
};

}  // namespace suffuse

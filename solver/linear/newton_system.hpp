#pragma once

/// Solves the systems of Newton's method, whose matrices differ from a symmetric positive definite
/// one by little: by BiCGSTAB (van der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631) with the
/// factor of the symmetric one, or directly where that takes long.

#include <Eigen/SparseCore>
#include <memory>
#include <utility>

#include "linear/cholesky_factor.hpp"
#include "linear/lagged_preconditioner.hpp"

namespace suffuse {

class NewtonSystem {
 public:
  explicit NewtonSystem(std::unique_ptr<Factor> factor = std::make_unique<CholeskyFactor>())
      : factor_(std::move(factor)) {}

  /// The symmetric matrix, nearly the one to be solved; with the values of the last call nothing is
  /// done. Throws NumericalError when it is not positive definite.
  void factorise(const Eigen::SparseMatrix<double>& nearly);

  /// Sets x to the solution of matrix x = rhs. Throws NumericalError where there is none, and where
  /// iterations with a factor that is not exact do not find it: such matrices are too large to be
  /// solved directly.
  /// \param accuracy  of the residual, relative to the right-hand side
  void solve(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
             Eigen::VectorXd& x, double accuracy = 1e-9);

  /// Solves for a tangent that is far from the symmetric matrix, in a problem whose next iteration
  /// corrects what this one leaves: with a factor that is not exact, the residual may be 1e-4 of
  /// the right-hand side.
  void solve_tangent(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
                     Eigen::VectorXd& x);

  [[nodiscard]] const SolveCounts& counts() const { return counts_; }

  /// The factor is made again, of the same values and thus with the same bits; `pattern` is that of
  /// the matrices.
  void archive(auto& archive, const Eigen::SparseMatrix<double>& pattern) {
    archive(counts_, factored_);
    if (!archive.restores() || factored_.size() == 0) return;
    if (factored_.size() != pattern.nonZeros()) archive.misfit();
    Eigen::SparseMatrix<double> matrix = pattern;
    Eigen::Map<Eigen::VectorXd>(matrix.valuePtr(), matrix.nonZeros()) = factored_;
    factor_->factorise(matrix);
  }

 private:
  /// Iterates with this preconditioner. Returns whether that gave the solution.
  template <class Matrix, class Preconditioner>
  bool iterate(const Matrix& matrix, const Preconditioner& preconditioner,
               const Eigen::VectorXd& rhs, Eigen::VectorXd& x, double accuracy);
  [[noreturn]] static void refuse_unsolved();

  std::unique_ptr<Factor> factor_;
  Eigen::VectorXd factored_;  ///< values of the matrix that is factored
  SolveCounts counts_;
};

}  // namespace suffuse

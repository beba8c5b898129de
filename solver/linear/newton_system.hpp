#pragma once

/// Solves the systems of Newton's method, whose matrices are close to a symmetric positive definite
/// one, by BiCGSTAB (van der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631) with the factor of
/// the symmetric one, or directly where that takes less time.

#include <Eigen/SparseCore>
#include <memory>
#include <utility>

#include "linear/cholesky_factor.hpp"
#include "linear/lagged_preconditioner.hpp"
#include "linear/lu_factor.hpp"

namespace suffuse {

class NewtonSystem {
 public:
  explicit NewtonSystem(std::unique_ptr<Factor> factor = std::make_unique<CholeskyFactor>())
      : factor_(std::move(factor)) {}

  /// Factors the symmetric matrix near the one to be solved; does nothing if its values are those
  /// of the last call. Throws NumericalError if it is not positive definite.
  void factorise(const Eigen::SparseMatrix<double>& nearly);

  [[nodiscard]] bool is_factored() const { return factored_.size() > 0; }
  /// Sets x to the solution with the factored matrix itself.
  void solve_nearly(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) { factor_->solve(rhs, x); }

  /// Sets x to the solution of matrix x = rhs, by iterations with the factor of the symmetric
  /// matrix; directly if they fail, and from then on. Throws NumericalError if there is none, or if
  /// iterations with an inexact factor do not find it: such matrices are too large to be solved
  /// directly.
  /// \param accuracy  of the residual, relative to the right-hand side
  void solve(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
             Eigen::VectorXd& x, double accuracy = 1e-9);
  /// Lets `solve` iterate again.
  void iterate_again() { iterations_failed_ = false; }

  /// Solves for a tangent that may be far from the symmetric matrix `nearly`, where the next
  /// iteration of the caller corrects the error: directly if the factor is exact; else the residual
  /// may be 1e-4 of the right-hand side.
  void solve_tangent(const Eigen::SparseMatrix<double>& nearly,
                     const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
                     Eigen::VectorXd& x);

  [[nodiscard]] const SolveCounts& counts() const { return counts_; }

  /// The factor is made again from its values, with the same bits; `pattern` is that of the
  /// matrices. Without `is_used` what is restored is dropped.
  void archive(auto& archive, const Eigen::SparseMatrix<double>& pattern, bool is_used = true) {
    archive(counts_);
    archive_factor(archive, pattern, is_used);
  }
  /// Archives all that `archive` does but the counts.
  void archive_factor(auto& archive, const Eigen::SparseMatrix<double>& pattern,
                      bool is_used = true) {
    archive(factored_);
    if (archive.restores() && !is_used) factored_.resize(0);
    if (!archive.restores() || factored_.size() == 0) return;
    if (factored_.size() != pattern.nonZeros()) archive.misfit();
    Eigen::SparseMatrix<double> matrix = pattern;
    Eigen::Map<Eigen::VectorXd>(matrix.valuePtr(), matrix.nonZeros()) = factored_;
    factor_->factorise(matrix);
  }

 private:
  [[nodiscard]] int most_iterations(const Eigen::SparseMatrix<double>& matrix);
  void solve_directly(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
                      Eigen::VectorXd& x, double accuracy);
  /// Iterates with this preconditioner, `most` times at most. Returns whether the solution was
  /// found.
  template <class Matrix, class Preconditioner>
  bool iterate(const Matrix& matrix, const Preconditioner& preconditioner,
               const Eigen::VectorXd& rhs, Eigen::VectorXd& x, double accuracy, int max_iterations);

  std::unique_ptr<Factor> factor_;
  Eigen::VectorXd factored_;  ///< values of the matrix that is factored
  LuFactor direct_;
  bool iterations_failed_ = false;
  SolveCounts counts_;
};

}  // namespace suffuse

#pragma once

/// Symmetric systems whose rows are shared by ranks.

#include <memory>
#include <vector>

#include "linear/lagged_preconditioner.hpp"
#include "linear/symmetric_system.hpp"
#include "ranks/ranks.hpp"
#include "ranks/shared_factor.hpp"

namespace suffuse {

class SharedSystem {
 public:
  /// `unknown`: for each of the rows of the mesh that are here, such as its faces, the number of
  /// its unknown among those here, ascending; -1 for none. A rank owns the unknowns of its rows.
  /// Keeps a reference to the ranks. All ranks have to call all functions.
  SharedSystem(const Ranks& ranks, const OwnRows& mesh_rows, const std::vector<int>& unknown);

  /// The unknowns that this rank owns.
  [[nodiscard]] NumberRange own() const { return rows_.own(); }

  /// Solution of a system of all unknowns that are here, of which the rows of own ones are
  /// complete: iterations, refined until each row has its tolerance, or the round-off of computing
  /// its residual. The pattern of the matrix is the same in every call. Throws NumericalError.
  Eigen::VectorXd solve(const SymmetricSystem& system);
  /// Solution of tangent x = rhs, whose matrix is near the symmetric positive definite `nearly`;
  /// the error is 1e-9 of the right-hand side. Throws NumericalError.
  Eigen::VectorXd solve_near(const Eigen::SparseMatrix<double>& nearly,
                             const Eigen::SparseMatrix<double>& tangent,
                             const Eigen::VectorXd& rhs);

  /// Counts of all calls so far; iterations are those of the preconditioner.
  [[nodiscard]] const SolveCounts& counts() const { return counts_; }

 private:
  void factorise(const Eigen::SparseMatrix<double>& matrix);
  /// The own rows of a matrix that is stored by rows.
  template <class RowMatrix>
  OwnMatrixRows own_rows(const RowMatrix& matrix) const;
  /// Finds the residual of own rows. Returns the largest ratio to that allowed, of all ranks.
  double find_residual(const SymmetricSystem& system, const std::vector<double>& x);

  const Ranks& ranks_;
  std::vector<long> numbers_;
  OwnRows rows_;
  int first_ = 0;
  int last_ = 0;
  long whole_ = 0;
  std::unique_ptr<SharedFactor> factor_;
  std::vector<double> factored_;  ///< values of the matrix that is factored
  std::vector<double> residual_;  ///< per own row
  SolveCounts counts_;
};

}  // namespace suffuse

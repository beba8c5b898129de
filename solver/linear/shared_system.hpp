#pragma once

/// Symmetric systems whose rows are shared by ranks.

#include <memory>
#include <vector>

#include "linear/symmetric_system.hpp"
#include "ranks/ranks.hpp"
#include "ranks/shared_factor.hpp"

namespace suffuse {

class SharedSystem {
 public:
  /// `numbers`: of the unknowns that are here, in the whole system; this rank owns those from
  /// `first` to `last`. Keeps a reference to the ranks. All ranks have to call all functions.
  SharedSystem(const Ranks& ranks, const std::vector<long>& numbers, int first, int last);

  /// Solution of a system of all unknowns that are here, of which the rows of own ones are
  /// complete: iterations, refined until each row has its tolerance, or the round-off of computing
  /// its residual. The pattern of the matrix is the same in every call. Throws NumericalError.
  Eigen::VectorXd solve(const SymmetricSystem& system);

  // In all calls so far; iterations are those of the preconditioner.
  [[nodiscard]] long solves() const { return solves_; }
  [[nodiscard]] long iterations() const { return iterations_; }

 private:
  void factorise(const Eigen::SparseMatrix<double>& matrix);
  /// Finds the residual of own rows. Returns the largest ratio to that allowed, of all ranks.
  double find_residual(const SymmetricSystem& system, const std::vector<double>& x);

  const Ranks& ranks_;
  std::vector<long> numbers_;
  OwnRows rows_;
  int first_;
  int last_;
  long whole_;
  std::unique_ptr<SharedFactor> factor_;
  std::vector<double> factored_;  ///< values of the matrix that is factored
  std::vector<double> residual_;  ///< per own row
  long solves_ = 0;
  long iterations_ = 0;
};

}  // namespace suffuse

#pragma once

/// Direct factor of a sparse symmetric positive definite matrix.

#include <Eigen/SparseCholesky>

#include "linear/factor.hpp"

namespace suffuse {

/// L D L^T by Eigen, with unknowns ordered by approximate minimum degree. Substitution is written
/// here as plain loops over the columns of L: they take half the time of Eigen's, and are most of
/// the cost of conjugate gradients (docs/develop/decisions.md has the numbers).
class CholeskyFactor final : public Factor {
 public:
  void factorise(const Eigen::SparseMatrix<double>& matrix) override;
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) override;

 private:
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool ordered_ = false;      ///< whether the pattern has been analyzed
  Eigen::VectorXd permuted_;  ///< unknowns in the order of the factor
};

}  // namespace suffuse

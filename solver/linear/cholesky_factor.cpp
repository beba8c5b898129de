#include "linear/cholesky_factor.hpp"

#include "common/errors.hpp"

namespace suffuse {

void CholeskyFactor::factorise(const Eigen::SparseMatrix<double>& matrix) {
  if (!ordered_) factor_.analyzePattern(matrix);
  ordered_ = true;
  factor_.factorize(matrix);
  if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0.0)) {
    throw NumericalError(
        "a linear system could not be solved: its matrix is not positive definite");
  }
}

void CholeskyFactor::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
  // L without its unit diagonal.
  const Eigen::SparseMatrix<double>& lower = factor_.matrixL().nestedExpression();
  const int* first = lower.outerIndexPtr();
  const int* row = lower.innerIndexPtr();
  const double* value = lower.valuePtr();
  const auto columns = static_cast<int>(lower.cols());

  permuted_ = factor_.permutationP() * rhs;
  double* y = permuted_.data();
  for (int j = 0; j < columns; ++j) {
    const double known = y[j];
    for (int k = first[j]; k < first[j + 1]; ++k) y[row[k]] -= value[k] * known;
  }
  permuted_.array() /= factor_.vectorD().array();
  for (int j = columns; j-- > 0;) {
    double sum = 0.0;
    for (int k = first[j]; k < first[j + 1]; ++k) sum += value[k] * y[row[k]];
    y[j] -= sum;
  }
  x = factor_.permutationPinv() * permuted_;
}

}  // namespace suffuse

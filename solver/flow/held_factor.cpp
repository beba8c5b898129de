#include "flow/held_factor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "case/errors.hpp"

namespace suffuse {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Residual per row that double precision cannot tell from nothing: a row's terms are as large as
/// its diagonal times the largest unknown.
Eigen::VectorXd with_round_off(const Matrix& matrix, const Eigen::VectorXd& rhs,
                               const Eigen::VectorXd& x, const Eigen::VectorXd& tolerance) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double largest = x.lpNorm<Eigen::Infinity>();
  return tolerance.array() +
         4.0 * epsilon * (rhs.array().abs() + largest * matrix.diagonal().array());
}

/// Largest residual over what is allowed; infinite where nothing is and something is left.
double excess(const Eigen::VectorXd& residual, const Eigen::VectorXd& allowed) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    if (residual[i] != 0.0) largest = std::max(largest, std::abs(residual[i]) / allowed[i]);
    if (std::isnan(residual[i])) return residual[i];
  }
  return largest;
}

bool within(const Eigen::VectorXd& residual, const Eigen::VectorXd& allowed) {
  return excess(residual, allowed) <= 1.0;
}

}  // namespace

HeldFactor::HeldFactor(const Matrix& pattern) {
  factor_.analyzePattern(pattern);
}

void HeldFactor::factorise(const Matrix& matrix) {
  factored_values_.clear();  // nothing is held if this throws
  last_iterations_ = 0;
  factor_.factorize(matrix);
  ++counts_.factorisations;
  if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0.0)) {
    throw NumericalError(
        "the pressures could not be solved for: the matrix of the flow is not positive definite");
  }
  factored_values_.assign(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros());
}

bool HeldFactor::is_factored(const Matrix& matrix) const {
  return !factored_values_.empty() &&
         std::equal(factored_values_.begin(), factored_values_.end(), matrix.valuePtr());
}

Eigen::VectorXd HeldFactor::solve_directly(const Matrix& matrix, const Eigen::VectorXd& rhs,
                                           const Eigen::VectorXd& tolerance) const {
  Eigen::VectorXd x = factor_.solve(rhs);
  const Eigen::VectorXd residual = rhs - matrix * x;
  if (!within(residual, with_round_off(matrix, rhs, x, tolerance))) x += factor_.solve(residual);
  return x;
}

bool HeldFactor::iterate(const Matrix& matrix, const Eigen::VectorXd& rhs,
                         const Eigen::VectorXd& tolerance, Eigen::VectorXd& x) {
  Eigen::VectorXd residual = rhs - matrix * x;
  int iterations = 0;
  double first_excess = 0.0;
  // Conjugate gradients update the residual rather than compute it, and the two drift apart: begin
  // again from the true one where they have.
  while (true) {
    const Eigen::VectorXd enough = with_round_off(matrix, rhs, x, tolerance);
    if (within(residual, enough)) return true;
    if (iterations == most_iterations) return false;
    Eigen::VectorXd direction;
    double last_product = 0.0;
    while (iterations < most_iterations) {
      const double now = excess(residual, 0.5 * enough);
      if (now <= 1.0) break;
      if (iterations == 0) first_excess = now;
      // Less than half the progress that a third of the iterations should have made: hopeless.
      if (iterations == most_iterations / 3 &&
          std::log(first_excess / now) < std::log(first_excess) / 6.0) {
        return false;
      }
      const Eigen::VectorXd preconditioned = factor_.solve(residual);
      const double product = residual.dot(preconditioned);
      if (direction.size() == 0) {
        direction = preconditioned;
      } else {
        direction = preconditioned + (product / last_product) * direction;
      }
      last_product = product;
      const Eigen::VectorXd image = matrix * direction;
      const double curvature = direction.dot(image);
      if (!(product > 0.0 && curvature > 0.0)) return false;
      const double length = product / curvature;
      x += length * direction;
      residual -= length * image;
      ++iterations;
      ++counts_.iterations;
    }
    residual = rhs - matrix * x;
  }
}

Eigen::VectorXd HeldFactor::solve(const Matrix& matrix, const Eigen::VectorXd& rhs,
                                  const Eigen::VectorXd& guess, const Eigen::VectorXd& tolerance) {
  ++counts_.solves;
  if (matrix.rows() == 0) return rhs;
  const bool again =
      !iterated_values_.empty() &&
      std::equal(iterated_values_.begin(), iterated_values_.end(), matrix.valuePtr());
  if (!again) spent_ = 0;
  if (!factored_values_.empty() && last_iterations_ <= tiring_iterations &&
      spent_ < worth_a_factor && !is_factored(matrix)) {
    Eigen::VectorXd x = guess;
    const long before = counts_.iterations;
    const bool solved = iterate(matrix, rhs, tolerance, x);
    last_iterations_ = counts_.iterations - before;
    spent_ += last_iterations_;
    if (!again) {
      iterated_values_.assign(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros());
    }
    if (solved) return x;
  }
  if (!is_factored(matrix)) factorise(matrix);
  Eigen::VectorXd x = solve_directly(matrix, rhs, tolerance);
  if (!x.allFinite()) {
    throw NumericalError("the pressures could not be solved for: they are not finite numbers");
  }
  return x;
}

}  // namespace suffuse

#include "linear/lagged_preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "case/errors.hpp"
#include "grid/parallel.hpp"

namespace suffuse {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// A row of a symmetric matrix, which is its column, times a vector.
double row_times(const Matrix& matrix, int row, const Eigen::VectorXd& x) {
  const int* columns = matrix.innerIndexPtr();
  const double* values = matrix.valuePtr();
  double sum = 0.0;
  for (int k = matrix.outerIndexPtr()[row]; k < matrix.outerIndexPtr()[row + 1]; ++k) {
    sum += values[k] * x[columns[k]];
  }
  return sum;
}

/// Sum of products in blocks of fixed size: the same on any number of threads.
double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int threads) {
  constexpr int block = 4096;
  const auto size = static_cast<int>(a.size());
  const int blocks = (size + block - 1) / block;
  std::vector<double> part(blocks);
  const auto add_up = [&](int i) {
    const int begin = i * block;
    const int length = std::min(block, size - begin);
    part[i] = a.segment(begin, length).dot(b.segment(begin, length));
  };
  for_each_index(blocks, size >= worth_threads ? threads : 1, add_up, 1);
  return std::accumulate(part.begin(), part.end(), 0.0);
}

}  // namespace

LaggedPreconditioner::LaggedPreconditioner(const Matrix& pattern, int threads)
    : threads_(threads), packed_(threads) {
  factor_.analyzePattern(pattern);
}

void LaggedPreconditioner::find_residual(const Matrix& matrix, const Eigen::VectorXd& rhs,
                                         const Eigen::VectorXd& x,
                                         Eigen::VectorXd& residual) const {
  residual.resize(rhs.size());
  for_each_index(static_cast<int>(rhs.size()), threads_,
                 [&](int row) { residual[row] = rhs[row] - row_times(matrix, row, x); });
}

void LaggedPreconditioner::find_allowed(const Eigen::VectorXd& rhs, const Eigen::VectorXd& x,
                                        const Eigen::VectorXd& tolerance,
                                        Eigen::VectorXd& allowed) const {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double largest = x.lpNorm<Eigen::Infinity>();
  allowed.resize(rhs.size());
  for_each_index(static_cast<int>(rhs.size()), threads_, [&](int row) {
    allowed[row] = tolerance[row] + 4.0 * epsilon * (std::abs(rhs[row]) + largest * diagonal_[row]);
  });
}

double LaggedPreconditioner::excess(const Eigen::VectorXd& residual, const Eigen::VectorXd& allowed,
                                    double share) const {
  const double largest = largest_of(static_cast<int>(residual.size()), threads_, 0.0, [&](int row) {
    // Comparisons with what is not a number are false: infinite is as bad.
    if (std::isnan(residual[row])) return std::numeric_limits<double>::infinity();
    return residual[row] == 0.0 ? 0.0 : std::abs(residual[row]) / (share * allowed[row]);
  });
  return largest;
}

void LaggedPreconditioner::factorise(const Matrix& matrix) {
  factored_values_.clear();  // nothing is held if this throws
  last_iterations_ = 0;
  factor_.factorize(matrix);
  ++counts_.factorisations;
  if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0.0)) {
    throw NumericalError(
        "the pressures could not be solved for: the matrix of the flow is not positive definite");
  }
  packed_.take(factor_);
  factor_.release();
  factored_values_.assign(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros());
}

void LaggedPreconditioner::archive(StateArchive& archive, const Matrix& pattern) {
  std::vector<double> factored = factored_values_;
  archive(factored, iterated_values_);
  if (archive.restores()) {
    factored_values_.clear();
    if (!factored.empty()) {
      Matrix matrix = pattern;
      if (factored.size() != static_cast<std::size_t>(matrix.nonZeros())) StateArchive::misfit();
      std::copy(factored.begin(), factored.end(), matrix.valuePtr());
      factorise(matrix);
    }
  }
  archive(last_iterations_, spent_, counts_);
}

bool LaggedPreconditioner::is_factored(const Matrix& matrix) const {
  return !factored_values_.empty() &&
         std::equal(factored_values_.begin(), factored_values_.end(), matrix.valuePtr());
}

Eigen::VectorXd LaggedPreconditioner::solve_directly(const Matrix& matrix,
                                                     const Eigen::VectorXd& rhs,
                                                     const Eigen::VectorXd& tolerance) {
  Eigen::VectorXd x;
  packed_.solve(rhs, x);
  find_residual(matrix, rhs, x, residual_);
  find_allowed(rhs, x, tolerance, allowed_);
  if (!(excess(residual_, allowed_, 1.0) <= 1.0)) {
    packed_.solve(residual_, preconditioned_);
    x += preconditioned_;
  }
  return x;
}

bool LaggedPreconditioner::iterate(const Matrix& matrix, const Eigen::VectorXd& rhs,
                                   const Eigen::VectorXd& tolerance, Eigen::VectorXd& x) {
  const auto rows = static_cast<int>(rhs.size());
  int iterations = 0;
  double first_excess = 0.0;
  // Conjugate gradients update the residual rather than compute it, and the two drift apart: begin
  // again from the true one where they have.
  while (true) {
    find_residual(matrix, rhs, x, residual_);
    find_allowed(rhs, x, tolerance, allowed_);
    if (excess(residual_, allowed_, 1.0) <= 1.0) return true;
    if (iterations == most_iterations) return false;
    double last_product = 0.0;
    while (iterations < most_iterations) {
      const double now = excess(residual_, allowed_, 0.5);
      if (now <= 1.0) break;
      if (iterations == 0) first_excess = now;
      // Less than half the progress that a third of the iterations should have made: hopeless.
      if (iterations == most_iterations / 3 &&
          std::log(first_excess / now) < std::log(first_excess) / 6.0) {
        return false;
      }
      packed_.solve(residual_, preconditioned_);
      const double product = dot(residual_, preconditioned_, threads_);
      if (last_product == 0.0) {
        direction_ = preconditioned_;
      } else {
        const double share = product / last_product;
        for_each_index(rows, threads_,
                       [&](int i) { direction_[i] = preconditioned_[i] + share * direction_[i]; });
      }
      last_product = product;
      image_.resize(rows);
      for_each_index(rows, threads_,
                     [&](int row) { image_[row] = row_times(matrix, row, direction_); });
      const double curvature = dot(direction_, image_, threads_);
      if (!(product > 0.0 && curvature > 0.0)) return false;
      const double length = product / curvature;
      for_each_index(rows, threads_, [&](int i) {
        x[i] += length * direction_[i];
        residual_[i] -= length * image_[i];
      });
      ++iterations;
      ++counts_.iterations;
    }
  }
}

Eigen::VectorXd LaggedPreconditioner::solve(const Matrix& matrix, const Eigen::VectorXd& rhs,
                                            const Eigen::VectorXd& guess,
                                            const Eigen::VectorXd& tolerance) {
  ++counts_.solves;
  if (matrix.rows() == 0) return rhs;
  diagonal_ = matrix.diagonal();
  const bool again =
      !iterated_values_.empty() &&
      std::equal(iterated_values_.begin(), iterated_values_.end(), matrix.valuePtr());
  if (!again) spent_ = 0;
  const bool held = is_factored(matrix);
  if (!factored_values_.empty() && last_iterations_ <= tiring_iterations &&
      spent_ < worth_a_factor && !held) {
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
  if (!held) factorise(matrix);
  Eigen::VectorXd x = solve_directly(matrix, rhs, tolerance);
  if (!x.allFinite()) {
    throw NumericalError("the pressures could not be solved for: they are not finite numbers");
  }
  return x;
}

}  // namespace suffuse

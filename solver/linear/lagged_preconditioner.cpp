#include "linear/lagged_preconditioner.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "common/errors.hpp"
#include "linear/multigrid.hpp"

namespace suffuse {
namespace {

/// Multigrid takes 15 to 60 iterations.
constexpr int max_patient_iterations = 1000;
/// Rows up to which a direct factor replaces multigrid that does not converge: it takes some 10 GB
/// there in three dimensions.
constexpr int most_direct_rows = 300'000;

/// Copies without new memory if there is enough.
void copy_values(const Eigen::SparseMatrix<double>& matrix, std::vector<double>& values) {
  values.assign(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros());
}

/// Whether these are the values of the matrix; false if there are none.
bool are_values_of(const std::vector<double>& values, const Eigen::SparseMatrix<double>& matrix) {
  return !values.empty() && std::equal(values.begin(), values.end(), matrix.valuePtr());
}

}  // namespace

std::unique_ptr<Factor> flow_factor(int dimension, int faces) {
  if (prefers_multigrid(dimension, faces)) return std::make_unique<Multigrid>();
  return std::make_unique<CholeskyFactor>();
}

std::unique_ptr<Factor> newton_factor(int dimension, int faces) {
  if (dimension == 3 && faces >= 3'000) return std::make_unique<Multigrid>();
  return std::make_unique<CholeskyFactor>();
}

LaggedPreconditioner::LaggedPreconditioner(int threads, LagLimits limits,
                                           std::unique_ptr<Factor> factor)
    : limits_(limits),
      factor_(std::move(factor)),
      conjugate_gradients_(threads, limits.solution),
      patient_gradients_(threads, {max_patient_iterations, max_patient_iterations, 0.0}),
      residual_(threads) {}

void LaggedPreconditioner::factorise(const Matrix& matrix) {
  factored_values_.clear();  // there is no factor if this throws
  last_iterations_ = 0;
  ++counts_.factorisations;
  factor_->factorise(matrix);
  copy_values(matrix, factored_values_);
}

Eigen::VectorXd LaggedPreconditioner::solve_directly(const SymmetricSystem& system) {
  if (!factor_->is_exact()) {
    // Allowed residuals depend on the size of the solution, so a first one is needed.
    Eigen::VectorXd solution = system.guess;
    residual_.compute(system, solution);
    if (residual_.is_allowed()) return solution;
    factor_->solve(residual_.values, correction_);
    solution += correction_;
    const bool solved = patient_gradients_.solve(system, *factor_, solution);
    counts_.iterations += patient_gradients_.iterations();
    if (solved) return solution;
    if (system.matrix.rows() > most_direct_rows) {
      throw NumericalError("a linear system could not be solved: " +
                           std::to_string(patient_gradients_.iterations()) +
                           " iterations with multigrid are not enough; expected is a conductivity "
                           "that differs less along and across the bedding, or a coarser mesh");
    }
    CholeskyFactor exact;
    exact.factorise(system.matrix);
    return refined_solution(exact, system);
  }
  return refined_solution(*factor_, system);
}

Eigen::VectorXd LaggedPreconditioner::refined_solution(Factor& exact,
                                                       const SymmetricSystem& system) {
  Eigen::VectorXd x;
  exact.solve(system.rhs, x);
  residual_.compute(system, x);
  if (!residual_.is_allowed()) {
    exact.solve(residual_.values, correction_);
    x += correction_;
  }
  return x;
}

bool LaggedPreconditioner::solve_by_iterations(const SymmetricSystem& system, Eigen::VectorXd& x) {
  const bool solved = conjugate_gradients_.solve(system, *factor_, x);
  last_iterations_ = conjugate_gradients_.iterations();
  counts_.iterations += last_iterations_;
  repeated_iterations_ += last_iterations_;
  return solved;
}

Eigen::VectorXd LaggedPreconditioner::solve(const SymmetricSystem& system) {
  const Matrix& matrix = system.matrix;
  ++counts_.solves;
  if (matrix.rows() == 0) return system.rhs;
  const bool repeated = are_values_of(iterated_values_, matrix);
  if (!repeated) repeated_iterations_ = 0;
  const bool factored = are_values_of(factored_values_, matrix);
  // An inexact factor is made anew at the cost of a few iterations.
  if (factor_->is_exact() && !factored && !factored_values_.empty() &&
      last_iterations_ <= limits_.tiring_iterations &&
      repeated_iterations_ < limits_.repeated_iterations) {
    Eigen::VectorXd x = system.guess;
    const bool solved = solve_by_iterations(system, x);
    if (!repeated) copy_values(matrix, iterated_values_);
    if (solved) return x;
  }
  if (!factored) factorise(matrix);
  Eigen::VectorXd x = solve_directly(system);
  if (!x.allFinite()) {
    throw NumericalError(
        "a linear system could not be solved: not all numbers of the solution are finite");
  }
  return x;
}

}  // namespace suffuse

#include "linear/newton_system.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <limits>
#include <string>

#include "common/errors.hpp"

namespace suffuse {
namespace {

constexpr int max_iterations = 60;
constexpr double tangent_accuracy = 1e-4;
/// One iteration of BiCGSTAB in solutions with the symmetric factor: two, and two products with the
/// matrix.
constexpr double iteration_effort = 3.0;
constexpr double direct_accuracy = 1e-9;
/// Corrections of a direct solution.
constexpr int max_corrections = 3;
/// Residual of a direct solution that is accepted, in units of its round-off.
constexpr double round_off_units = 16.0;

[[noreturn]] void refuse_unsolved() {
  throw NumericalError("the pressures were not found in " + std::to_string(max_iterations) +
                       " iterations");
}

/// Round-off of computing a residual: where coefficients differ by many orders of magnitude it
/// exceeds any share of the right-hand side.
double round_off(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& x) {
  return std::numeric_limits<double>::epsilon() * (matrix.cwiseAbs() * x.cwiseAbs()).norm();
}

/// The factor with the interface of Eigen's preconditioners.
class FactorPreconditioner {
 public:
  template <class Matrix>
  FactorPreconditioner& analyzePattern(const Matrix& /*matrix*/) {  // NOLINT: Eigen's name
    return *this;
  }
  template <class Matrix>
  FactorPreconditioner& factorize(const Matrix& /*matrix*/) {
    return *this;
  }
  template <class Matrix>
  FactorPreconditioner& compute(const Matrix& /*matrix*/) {
    return *this;
  }
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& rhs) const {
    Eigen::VectorXd x;
    factor->solve(rhs, x);
    return x;
  }
  [[nodiscard]] static Eigen::ComputationInfo info() { return Eigen::Success; }

  Factor* factor = nullptr;
};

using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The factor of the symmetric matrix, then Gauss-Seidel forward and backward with the matrix
/// itself: where water enters dry soil the two matrices differ most, and couplings act in one
/// direction. Two stages as for flow in reservoirs (Wallis, SPE 12265 (1983)).
class TwoStagePreconditioner : public FactorPreconditioner {
 public:
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& rhs) const {
    Eigen::VectorXd x;
    factor->solve(rhs, x);
    const auto count = static_cast<int>(x.size());
    for (int i = 0; i < count; ++i) relax(i, rhs, x);
    for (int i = count; i-- > 0;) relax(i, rhs, x);
    return x;
  }

  const Rows* rows = nullptr;

 private:
  void relax(int i, const Eigen::VectorXd& rhs, Eigen::VectorXd& x) const {
    double left = rhs[i];
    double diagonal = 0.0;
    for (Rows::InnerIterator it(*rows, i); it; ++it) {
      left -= it.value() * x[it.col()];
      if (it.col() == i) diagonal = it.value();
    }
    if (diagonal > 0.0) x[i] += left / diagonal;
  }
};

}  // namespace

void NewtonSystem::factorise(const Eigen::SparseMatrix<double>& nearly) {
  const Eigen::Map<const Eigen::VectorXd> values(nearly.valuePtr(), nearly.nonZeros());
  if (values.size() == factored_.size() && values == factored_) return;
  factored_.resize(0);
  factor_->factorise(nearly);
  factored_ = values;
  ++counts_.factorisations;
}

template <class Matrix, class Preconditioner>
bool NewtonSystem::iterate(const Matrix& matrix, const Preconditioner& preconditioner,
                           const Eigen::VectorXd& rhs, Eigen::VectorXd& x, double accuracy,
                           int most) {
  ++counts_.solves;
  Eigen::BiCGSTAB<Matrix, Preconditioner> iterations;
  iterations.preconditioner() = preconditioner;
  iterations.setTolerance(accuracy);
  iterations.setMaxIterations(most);
  iterations.compute(matrix);
  x = iterations.solve(rhs);
  counts_.iterations += iterations.iterations();
  return iterations.info() == Eigen::Success && x.allFinite();
}

void NewtonSystem::solve_directly(const Eigen::SparseMatrix<double>& matrix,
                                  const Eigen::VectorXd& rhs, Eigen::VectorXd& x, double accuracy) {
  ++counts_.solves;
  ++counts_.factorisations;
  direct_.factorise(matrix);
  direct_.solve(rhs, x);
  const double allowed = accuracy * rhs.norm();
  Eigen::VectorXd correction;
  for (int k = 0;; ++k) {
    const Eigen::VectorXd residual = rhs - matrix * x;
    const double left = residual.norm();
    if (left <= allowed || left <= round_off_units * round_off(matrix, x)) return;
    if (k == max_corrections) throw NumericalError("the system is nearly singular");
    direct_.solve(residual, correction);
    x += correction;
  }
}

/// The iterations that take no longer than a direct solution: a few in two dimensions.
int NewtonSystem::most_iterations(const Eigen::SparseMatrix<double>& matrix) {
  if (!factor_->is_exact()) return max_iterations;
  direct_.analyse(matrix);
  return static_cast<int>(
      std::clamp(direct_.effort() / iteration_effort, 1.0, 1.0 * max_iterations));
}

void NewtonSystem::solve(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
                         Eigen::VectorXd& x, double accuracy) {
  if (!iterations_failed_) {
    FactorPreconditioner preconditioner;
    preconditioner.factor = factor_.get();
    if (iterate(matrix, preconditioner, rhs, x, accuracy, most_iterations(matrix))) return;
    if (!factor_->is_exact()) refuse_unsolved();
  }
  iterations_failed_ = true;
  solve_directly(matrix, rhs, x, accuracy);
}

void NewtonSystem::solve_tangent(const Eigen::SparseMatrix<double>& nearly,
                                 const Eigen::SparseMatrix<double>& matrix,
                                 const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
  if (factor_->is_exact()) return solve_directly(matrix, rhs, x, direct_accuracy);
  factorise(nearly);
  const Rows rows = matrix;
  TwoStagePreconditioner preconditioner;
  preconditioner.factor = factor_.get();
  preconditioner.rows = &rows;
  if (!iterate(matrix, preconditioner, rhs, x, tangent_accuracy, max_iterations)) refuse_unsolved();
}

}  // namespace suffuse

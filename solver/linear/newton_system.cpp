#include "linear/newton_system.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseLU>
#include <string>

#include "common/errors.hpp"

namespace suffuse {
namespace {

constexpr int max_iterations = 60;
constexpr double tangent_accuracy = 1e-4;

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
                           const Eigen::VectorXd& rhs, Eigen::VectorXd& x, double accuracy) {
  ++counts_.solves;
  Eigen::BiCGSTAB<Matrix, Preconditioner> iterations;
  iterations.preconditioner() = preconditioner;
  iterations.setTolerance(accuracy);
  iterations.setMaxIterations(max_iterations);
  iterations.compute(matrix);
  x = iterations.solve(rhs);
  counts_.iterations += iterations.iterations();
  return iterations.info() == Eigen::Success && x.allFinite();
}

void NewtonSystem::refuse_unsolved() {
  throw NumericalError("the pressures were not found in " + std::to_string(max_iterations) +
                       " iterations");
}

void NewtonSystem::solve(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
                         Eigen::VectorXd& x, double accuracy) {
  if (!goes_on_directly_ || !iterations_failed_) {
    FactorPreconditioner preconditioner;
    preconditioner.factor = factor_.get();
    if (iterate(matrix, preconditioner, rhs, x, accuracy)) return;
    if (!factor_->is_exact()) refuse_unsolved();
  }
  if (!direct_) {
    direct_ = std::make_unique<Eigen::SparseLU<Eigen::SparseMatrix<double>>>();
    direct_->analyzePattern(matrix);
  }
  direct_->factorize(matrix);
  if (direct_->info() == Eigen::Success) x = direct_->solve(rhs);
  if (direct_->info() != Eigen::Success || !x.allFinite()) {
    throw NumericalError("the pressures could not be solved for: the system is singular");
  }
  iterations_failed_ = true;
}

void NewtonSystem::solve_tangent(const Eigen::SparseMatrix<double>& matrix,
                                 const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
  if (factor_->is_exact()) return solve(matrix, rhs, x);
  const Rows rows = matrix;
  TwoStagePreconditioner preconditioner;
  preconditioner.factor = factor_.get();
  preconditioner.rows = &rows;
  if (!iterate(matrix, preconditioner, rhs, x, tangent_accuracy)) refuse_unsolved();
}

}  // namespace suffuse

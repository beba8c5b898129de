#include "linear/newton_system.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseLU>
#include <string>

#include "case/errors.hpp"

namespace suffuse {
namespace {

constexpr int max_iterations = 60;

/// The factor, as Eigen's iterations call a preconditioner.
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

}  // namespace

void NewtonSystem::factorise(const Eigen::SparseMatrix<double>& nearly) {
  const Eigen::Map<const Eigen::VectorXd> values(nearly.valuePtr(), nearly.nonZeros());
  if (values.size() == factored_.size() && values == factored_) return;
  factored_.resize(0);
  factor_->factorise(nearly);
  factored_ = values;
  ++counts_.factorisations;
}

void NewtonSystem::solve(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
                         Eigen::VectorXd& x, double accuracy) {
  ++counts_.solves;
  Eigen::BiCGSTAB<Eigen::SparseMatrix<double>, FactorPreconditioner> iterations;
  iterations.preconditioner().factor = factor_.get();
  iterations.setTolerance(accuracy);
  iterations.setMaxIterations(max_iterations);
  iterations.compute(matrix);
  x = iterations.solve(rhs);
  counts_.iterations += iterations.iterations();
  if (iterations.info() == Eigen::Success && x.allFinite()) return;
  if (!factor_->is_exact()) {
    throw NumericalError("the pressures were not found in " + std::to_string(max_iterations) +
                         " iterations");
  }
  Eigen::SparseLU<Eigen::SparseMatrix<double>> direct(matrix);
  if (direct.info() == Eigen::Success) x = direct.solve(rhs);
  if (direct.info() != Eigen::Success || !x.allFinite()) {
    throw NumericalError("the pressures could not be solved for: the system is singular");
  }
}

}  // namespace suffuse

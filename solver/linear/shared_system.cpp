#include "linear/shared_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/errors.hpp"

namespace suffuse {

SharedSystem::SharedSystem(const Ranks& ranks, const std::vector<long>& numbers, int first,
                           int last)
    : ranks_(ranks),
      numbers_(numbers),
      rows_(ranks.rows(numbers, first, last)),
      first_(first),
      last_(last),
      factor_(ranks.symmetric_factor()),
      residual_(static_cast<std::size_t>(last - first)) {
  whole_ = static_cast<long>(sum_of_all(ranks, last - first));
}

void SharedSystem::factorise(const Eigen::SparseMatrix<double>& matrix) {
  const double* values = matrix.valuePtr();
  // Of own rows: those of others are not complete.
  const int begin = matrix.outerIndexPtr()[first_];
  const int end = matrix.outerIndexPtr()[last_];
  const bool same =
      !factored_.empty() && std::equal(factored_.begin(), factored_.end(), values + begin);
  if (!any_of_all(ranks_, !same)) return;
  factored_.assign(values + begin, values + end);
  OwnMatrixRows own;
  own.whole = whole_;
  for (int row = first_; row <= last_; ++row) {
    own.begin.push_back(matrix.outerIndexPtr()[row] - begin);
  }
  // A row of a symmetric matrix is its column.
  own.column.reserve(factored_.size());
  for (int k = begin; k < end; ++k) own.column.push_back(numbers_[matrix.innerIndexPtr()[k]]);
  own.value = factored_;
  factor_->factorise(own);
}

double SharedSystem::find_residual(const SymmetricSystem& system, const std::vector<double>& x) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  double highest = 0.0;
  for (int row = first_; row < last_; ++row) highest = std::max(highest, std::abs(x[row]));
  highest = largest_of_all(ranks_, highest);
  const int* columns = system.matrix.innerIndexPtr();
  const double* entries = system.matrix.valuePtr();
  double excess = 0.0;
  for (int row = first_; row < last_; ++row) {
    double sum = 0.0;
    double diagonal = 0.0;
    for (int k = system.matrix.outerIndexPtr()[row]; k < system.matrix.outerIndexPtr()[row + 1];
         ++k) {
      sum += entries[k] * x[columns[k]];
      if (columns[k] == row) diagonal = entries[k];
    }
    const double residual = system.rhs[row] - sum;
    const double allowed =
        system.tolerance[row] + 4.0 * epsilon * (std::abs(system.rhs[row]) + highest * diagonal);
    residual_[row - first_] = residual;
    // Comparisons with NaN are false: NaN counts as infinite.
    if (std::isnan(residual)) excess = std::numeric_limits<double>::infinity();
    if (residual != 0.0) excess = std::max(excess, std::abs(residual) / allowed);
  }
  return largest_of_all(ranks_, excess);
}

Eigen::VectorXd SharedSystem::solve(const SymmetricSystem& system) {
  // Refinements reduce the energy of the error, and the largest residual not always at once. After
  // some that have not halved it, the round-off of the residual is reached.
  constexpr double gain = 0.5;
  constexpr int most_without_gain = 3;
  ++solves_;
  factorise(system.matrix);
  std::vector<double> x(system.guess.data(), system.guess.data() + system.guess.size());
  rows_.exchange(x);
  double excess = find_residual(system, x);
  double least = excess;
  std::vector<double> best = x;
  std::vector<double> correction;
  for (int without_gain = 0; excess > 1.0 && without_gain < most_without_gain;) {
    iterations_ += factor_->solve(residual_, correction);
    for (int row = first_; row < last_; ++row) x[row] += correction[row - first_];
    rows_.exchange(x);
    excess = find_residual(system, x);
    if (!std::isfinite(excess)) {
      throw NumericalError("the pressures could not be solved for: they are not finite numbers");
    }
    without_gain = excess < gain * least ? 0 : without_gain + 1;
    if (excess < least) {
      least = excess;
      best = x;
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(best.data(), static_cast<Eigen::Index>(best.size()));
}

}  // namespace suffuse

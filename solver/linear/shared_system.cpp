#include "linear/shared_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/errors.hpp"

namespace suffuse {

SharedSystem::SharedSystem(const Ranks& ranks, const OwnRows& mesh_rows,
                           const std::vector<int>& unknown)
    : ranks_(ranks), factor_(ranks.symmetric_factor()) {
  const auto has_unknown = [&](int row) { return unknown[row] >= 0; };
  for (int row = 0; row < *mesh_rows.own().end(); ++row) {
    if (!has_unknown(row)) continue;
    ++last_;
    if (!mesh_rows.owns(row)) ++first_;
  }
  const int own = last_ - first_;
  whole_ = static_cast<long>(sum_of_all(ranks, own));
  residual_.resize(static_cast<std::size_t>(own));
  const long before = ranks.before(own);
  std::vector<long> of_row(unknown.size(), -1);
  for (const int row : mesh_rows.own()) {
    if (has_unknown(row)) of_row[row] = before + unknown[row] - first_;
  }
  mesh_rows.exchange(of_row);
  for (int row = 0; row < static_cast<int>(unknown.size()); ++row) {
    if (has_unknown(row)) numbers_.push_back(of_row[row]);
  }
  rows_ = ranks.rows(numbers_, first_, last_);
}

void SharedSystem::factorise(const Eigen::SparseMatrix<double>& matrix) {
  const double* values = matrix.valuePtr();
  // Own rows only: those of others are not complete.
  const int begin = matrix.outerIndexPtr()[first_];
  const int end = matrix.outerIndexPtr()[last_];
  const bool same =
      !factored_.empty() && std::equal(factored_.begin(), factored_.end(), values + begin);
  if (!any_of_all(ranks_, !same)) return;
  factored_.assign(values + begin, values + end);
  ++counts_.factorisations;
  // A row of a symmetric matrix is its column.
  factor_->factorise(own_rows(matrix));
}

template <class RowMatrix>
OwnMatrixRows SharedSystem::own_rows(const RowMatrix& matrix) const {
  const int* begin = matrix.outerIndexPtr();
  OwnMatrixRows own;
  own.whole = whole_;
  for (int row = first_; row <= last_; ++row) own.begin.push_back(begin[row] - begin[first_]);
  own.column.reserve(own.begin.back());
  for (int k = begin[first_]; k < begin[last_]; ++k) {
    own.column.push_back(numbers_[matrix.innerIndexPtr()[k]]);
  }
  own.value.assign(matrix.valuePtr() + begin[first_], matrix.valuePtr() + begin[last_]);
  return own;
}

Eigen::VectorXd SharedSystem::solve_near(const Eigen::SparseMatrix<double>& nearly,
                                         const Eigen::SparseMatrix<double>& tangent,
                                         const Eigen::VectorXd& rhs) {
  ++counts_.solves;
  factorise(nearly);
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = tangent;
  const std::vector<double> own(rhs.data() + first_, rhs.data() + last_);
  std::vector<double> found;
  counts_.iterations += factor_->solve_near(own_rows(rows), own, found);
  std::vector<double> x(rhs.size());
  std::ranges::copy(found, x.begin() + first_);
  rows_.exchange(x);
  return Eigen::Map<const Eigen::VectorXd>(x.data(), rhs.size());
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
  ++counts_.solves;
  factorise(system.matrix);
  std::vector<double> x(system.guess.data(), system.guess.data() + system.guess.size());
  rows_.exchange(x);
  double excess = find_residual(system, x);
  double least = excess;
  std::vector<double> best = x;
  std::vector<double> correction;
  for (int without_gain = 0; excess > 1.0 && without_gain < most_without_gain;) {
    counts_.iterations += factor_->solve(residual_, correction);
    for (int row = first_; row < last_; ++row) x[row] += correction[row - first_];
    rows_.exchange(x);
    excess = find_residual(system, x);
    if (!std::isfinite(excess)) {
      throw NumericalError(
          "a linear system could not be solved: not all numbers of the solution are finite");
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

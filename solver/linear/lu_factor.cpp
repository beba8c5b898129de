#include "linear/lu_factor.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cmath>

#include "common/errors.hpp"

namespace suffuse {

void LuFactor::order(const Eigen::SparseMatrix<double>& matrix) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> unknown;
  Eigen::AMDOrdering<int>()(matrix, unknown);
  place_ = unknown.inverse();
  const auto size = static_cast<int>(matrix.cols());
  diagonal_.assign(size, -1);
  std::vector<std::vector<Entry>> rows(size);
  const int* const index = matrix.innerIndexPtr();
  const auto find = [&](int row, int column) {
    const int* const end = index + matrix.outerIndexPtr()[column + 1];
    const int* const found = std::lower_bound(index + matrix.outerIndexPtr()[column], end, row);
    return found != end && *found == row ? static_cast<int>(found - index) : -1;
  };
  for (int j = 0; j < size; ++j) {
    for (int k = matrix.outerIndexPtr()[j]; k < matrix.outerIndexPtr()[j + 1]; ++k) {
      const int row = place_.indices()[index[k]];
      const int column = place_.indices()[j];
      if (row == column) diagonal_[row] = k;
      if (row < column) rows[column].push_back({row, find(j, index[k]), k});
    }
  }
  first_entry_.assign(1, 0);
  entries_.clear();
  for (std::vector<Entry>& row : rows) {
    std::ranges::sort(row, {}, &Entry::column);
    entries_.insert(entries_.end(), row.begin(), row.end());
    first_entry_.push_back(static_cast<int>(entries_.size()));
  }
  const bool is_complete = std::ranges::count(diagonal_, -1) == 0 &&
                           std::ranges::count(entries_, -1, &Entry::lower) == 0 &&
                           matrix.nonZeros() == stored();
  if (!is_complete) throw NumericalError("the pattern is not symmetric, or has no diagonal");
}

/// Counts the entries of each column of L, which are the rows whose paths through the elimination
/// tree pass the column.
void LuFactor::find_pattern() {
  const auto size = static_cast<int>(diagonal_.size());
  parent_.assign(size, -1);
  std::vector<int> count(size, 0);
  std::vector<int> passed_by(size, -1);
  for (int i = 0; i < size; ++i) {
    passed_by[i] = i;
    for (int k = first_entry_[i]; k < first_entry_[i + 1]; ++k) {
      for (int j = entries_[k].column; passed_by[j] != i; j = parent_[j]) {
        if (parent_[j] < 0) parent_[j] = i;
        passed_by[j] = i;
        ++count[j];
      }
    }
  }
  first_factor_.assign(1, 0);
  double squares = 0.0;
  for (const int entries : count) {
    first_factor_.push_back(first_factor_.back() + entries);
    squares += static_cast<double>(entries) * entries;
  }
  row_.resize(first_factor_.back());
  factor_.resize(first_factor_.back());
  pivot_.resize(size);
  effort_ = squares / std::max(2.0 * first_factor_.back(), 1.0);
}

void LuFactor::analyse(const Eigen::SparseMatrix<double>& matrix) {
  if (matrix.nonZeros() == stored()) return;
  order(matrix);
  find_pattern();
}

void LuFactor::factorise(const Eigen::SparseMatrix<double>& matrix) {
  analyse(matrix);
  const auto size = static_cast<int>(diagonal_.size());
  const double* const value = matrix.valuePtr();
  // What is left of a column above the diagonal, and of the row left of it, as columns before are
  // taken off.
  std::vector<Pair> left(size, Pair::Zero());
  std::vector<int> passed_by(size, -1);
  std::vector<int> path(size);
  std::vector<int> end(first_factor_.begin(), first_factor_.end() - 1);  // of what is known of L
  for (int i = 0; i < size; ++i) {
    // The columns that row i of L has, in the order of the tree: path[top ... size - 1].
    int top = size;
    passed_by[i] = i;
    for (int k = first_entry_[i]; k < first_entry_[i + 1]; ++k) {
      int j = entries_[k].column;
      left[j] = {value[entries_[k].upper], value[entries_[k].lower]};
      int length = 0;
      for (; passed_by[j] != i; j = parent_[j]) {
        path[length++] = j;
        passed_by[j] = i;
      }
      while (length > 0) path[--top] = path[--length];
    }
    double pivot = value[diagonal_[i]];
    for (; top < size; ++top) {
      const int j = path[top];
      const Pair entry(left[j][1] / pivot_[j], left[j][0]);
      const Pair taken(entry[1], entry[0]);
      left[j].setZero();
      for (int k = first_factor_[j]; k < end[j]; ++k) left[row_[k]] -= factor_[k] * taken;
      pivot -= entry[0] * entry[1];
      row_[end[j]] = i;
      factor_[end[j]++] = entry;
    }
    if (!std::isfinite(pivot) || pivot == 0.0) {
      throw NumericalError("the system is singular");
    }
    pivot_[i] = pivot;
  }
}

void LuFactor::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) const {
  Eigen::VectorXd y = place_ * rhs;
  const auto size = static_cast<int>(pivot_.size());
  for (int j = 0; j < size; ++j) {
    const double known = y[j];
    for (int k = first_factor_[j]; k < first_factor_[j + 1]; ++k) {
      y[row_[k]] -= factor_[k][0] * known;
    }
  }
  for (int j = size; j-- > 0;) {
    double sum = y[j];
    for (int k = first_factor_[j]; k < first_factor_[j + 1]; ++k) sum -= factor_[k][1] * y[row_[k]];
    y[j] = sum / pivot_[j];
  }
  x = place_.inverse() * y;
}

}  // namespace suffuse

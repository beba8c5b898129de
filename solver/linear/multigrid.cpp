#include "linear/multigrid.hpp"

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"

namespace suffuse {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// A level with at most this number of unknowns is factored.
constexpr int coarsest_size = 2000;
/// Couplings weaker than this share of a row's strongest one do not join unknowns.
constexpr double strong = 0.25;
/// A second step is left out if the first one leaves no more than this share of the residual.
constexpr double good_step = 0.25;

/// Pairs each unknown with the free one that it is coupled with most strongly.
std::vector<int> pairs_of(const Matrix& matrix, int& count) {
  const int* first = matrix.outerIndexPtr();
  const int* column = matrix.innerIndexPtr();
  const double* value = matrix.valuePtr();
  const auto rows = static_cast<int>(matrix.rows());
  std::vector<int> pair(rows, -1);
  count = 0;
  for (int i = 0; i < rows; ++i) {
    if (pair[i] >= 0) continue;
    double strongest = 0.0;
    double strongest_free = 0.0;
    int partner = -1;
    for (int k = first[i]; k < first[i + 1]; ++k) {
      if (column[k] == i) continue;
      const double coupling = -value[k];
      strongest = std::max(strongest, coupling);
      if (pair[column[k]] < 0 && coupling > strongest_free) {
        strongest_free = coupling;
        partner = column[k];
      }
    }
    if (partner >= 0 && strongest_free >= strong * strongest) pair[partner] = count;
    pair[i] = count++;
  }
  return pair;
}

/// Sums of the entries between aggregates.
Matrix coarse_matrix(const Matrix& matrix, const std::vector<int>& aggregate, int count) {
  const auto rows = static_cast<int>(matrix.rows());
  std::vector<int> first(count + 1, 0);
  for (const int a : aggregate) ++first[a + 1];
  for (int a = 0; a < count; ++a) first[a + 1] += first[a];
  std::vector<int> members(rows);
  std::vector<int> next(first.begin(), first.end() - 1);
  for (int i = 0; i < rows; ++i) members[next[aggregate[i]]++] = i;

  Matrix coarse(count, count);
  std::vector<int>& seen = next;
  seen.assign(count, -1);
  std::vector<double> sum(count, 0.0);
  std::vector<int> columns;
  coarse.reserve(matrix.nonZeros() / 2);
  for (int a = 0; a < count; ++a) {
    columns.clear();
    for (int m = first[a]; m < first[a + 1]; ++m) {
      for (Matrix::InnerIterator it(matrix, members[m]); it; ++it) {
        const int b = aggregate[it.row()];
        if (seen[b] != a) {
          seen[b] = a;
          sum[b] = 0.0;
          columns.push_back(b);
        }
        sum[b] += it.value();
      }
    }
    std::ranges::sort(columns);
    coarse.startVec(a);
    for (const int b : columns) coarse.insertBack(b, a) = sum[b];
  }
  coarse.finalize();
  return coarse;
}

/// Aggregates of pairs of pairs, and the matrix of the next level.
Matrix coarsened(const Matrix& matrix, std::vector<int>& aggregate) {
  int count = 0;
  aggregate = pairs_of(matrix, count);
  const Matrix halved = coarse_matrix(matrix, aggregate, count);
  const std::vector<int> again = pairs_of(halved, count);
  for (int& a : aggregate) a = again[a];
  return coarse_matrix(halved, again, count);
}

double row_product(const Matrix& matrix, int row, const Eigen::VectorXd& x) {
  double sum = 0.0;
  for (Matrix::InnerIterator it(matrix, row); it; ++it) sum += it.value() * x[it.row()];
  return sum;
}

void multiply(const Matrix& matrix, const Eigen::VectorXd& x, Eigen::VectorXd& product) {
  product.resize(x.size());
  for (int i = 0; i < static_cast<int>(x.size()); ++i) product[i] = row_product(matrix, i, x);
}

}  // namespace

void Multigrid::factorise(const Matrix& matrix) {
  levels_.clear();
  levels_.emplace_back().matrix = matrix;
  while (levels_.back().matrix.rows() > coarsest_size) {
    Level& fine = levels_.back();
    Matrix coarse = coarsened(fine.matrix, fine.aggregate);
    if (5 * coarse.rows() > 4 * fine.matrix.rows()) break;
    levels_.emplace_back().matrix.swap(coarse);
  }
  for (Level& level : levels_) {
    level.diagonal = level.matrix.diagonal();
    if (!(level.diagonal.minCoeff() > 0.0) || !level.diagonal.allFinite()) {
      throw NumericalError(
          "a linear system could not be solved: its matrix is not positive definite");
    }
  }
  coarsest_ = std::make_unique<CholeskyFactor>();
  coarsest_->factorise(levels_.back().matrix);
}

void Multigrid::smooth(const Level& level, const Eigen::VectorXd& rhs, bool forward,
                       Eigen::VectorXd& x) const {
  const auto rows = static_cast<int>(x.size());
  const auto relax = [&](int i) {
    x[i] += (rhs[i] - row_product(level.matrix, i, x)) / level.diagonal[i];
  };
  if (forward) {
    for (int i = 0; i < rows; ++i) relax(i);
  } else {
    for (int i = rows; i-- > 0;) relax(i);
  }
}

void Multigrid::cycle(std::size_t number, const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
  if (number + 1 == levels_.size()) {
    coarsest_->solve(rhs, x);
    return;
  }
  Level& level = levels_[number];
  Level& coarse = levels_[number + 1];
  x.setZero(rhs.size());
  smooth(level, rhs, true, x);
  coarse.rhs.setZero(coarse.matrix.rows());
  for (int i = 0; i < static_cast<int>(rhs.size()); ++i) {
    coarse.rhs[level.aggregate[i]] += rhs[i] - row_product(level.matrix, i, x);
  }
  solve_coarse(number + 1);
  for (int i = 0; i < static_cast<int>(rhs.size()); ++i) x[i] += coarse.x[level.aggregate[i]];
  smooth(level, rhs, false, x);
}

void Multigrid::solve_coarse(std::size_t number) {
  Level& level = levels_[number];
  if (number + 1 == levels_.size()) {
    coarsest_->solve(level.rhs, level.x);
    return;
  }
  cycle(number, level.rhs, level.direction);
  multiply(level.matrix, level.direction, level.image);
  const double curvature = level.direction.dot(level.image);
  const double gain = level.direction.dot(level.rhs);
  if (!(curvature > 0.0)) {
    level.x.setZero(level.rhs.size());
    return;
  }
  level.x = gain / curvature * level.direction;
  level.residual = level.rhs - gain / curvature * level.image;
  if (level.residual.norm() <= good_step * level.rhs.norm()) return;
  cycle(number, level.residual, level.second);
  multiply(level.matrix, level.second, level.second_image);
  const double mixed = level.second.dot(level.image);
  const double second_curvature = level.second.dot(level.second_image) - mixed * mixed / curvature;
  if (!(second_curvature > 0.0)) return;
  const double length = level.second.dot(level.residual) / second_curvature;
  level.x += length * (level.second - mixed / curvature * level.direction);
}

void Multigrid::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
  cycle(0, rhs, x);
}

}  // namespace suffuse

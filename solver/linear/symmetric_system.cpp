#include "linear/symmetric_system.hpp"

#include <cmath>
#include <limits>

#include "grid/parallel.hpp"

namespace suffuse {
void multiply(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& x, int threads,
              Eigen::VectorXd& product) {
  // A row of a symmetric matrix is its column.
  const int* columns = matrix.innerIndexPtr();
  const double* entries = matrix.valuePtr();
  product.resize(x.size());
  for_each_index(static_cast<int>(x.size()), threads, [&](int row) {
    const int end = matrix.outerIndexPtr()[row + 1];
    double sum = 0.0;
    for (int k = matrix.outerIndexPtr()[row]; k < end; ++k) sum += entries[k] * x[columns[k]];
    product[row] = sum;
  });
}

void Residual::compute(const SymmetricSystem& system, const Eigen::VectorXd& x) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const int* columns = system.matrix.innerIndexPtr();
  const double* entries = system.matrix.valuePtr();
  const double largest = x.lpNorm<Eigen::Infinity>();
  values.resize(x.size());
  allowed_.resize(x.size());
  for_each_index(static_cast<int>(x.size()), threads_, [&](int row) {
    double sum = 0.0;
    double diagonal = 0.0;
    const int end = system.matrix.outerIndexPtr()[row + 1];
    for (int k = system.matrix.outerIndexPtr()[row]; k < end; ++k) {
      sum += entries[k] * x[columns[k]];
      if (columns[k] == row) diagonal = entries[k];
    }
    values[row] = system.rhs[row] - sum;
    allowed_[row] =
        system.tolerance[row] + 4.0 * epsilon * (std::abs(system.rhs[row]) + largest * diagonal);
  });
}

double Residual::excess() const {
  return largest_of(static_cast<int>(values.size()), threads_, 0.0, [&](int row) {
    // Comparisons with NaN are false: NaN counts as infinite.
    if (std::isnan(values[row])) return std::numeric_limits<double>::infinity();
    return values[row] == 0.0 ? 0.0 : std::abs(values[row]) / allowed_[row];
  });
}

}  // namespace suffuse

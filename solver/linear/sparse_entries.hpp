#pragma once

/// Access to the entries of sparse matrices.

#include <Eigen/SparseCore>
#include <algorithm>

namespace suffuse {

/// Index among the values of a compressed matrix of an entry that its pattern has.
inline int slot_of(const Eigen::SparseMatrix<double>& matrix, int row, int column) {
  const int* const rows = matrix.innerIndexPtr();
  const int* const first = rows + matrix.outerIndexPtr()[column];
  const int* const last = rows + matrix.outerIndexPtr()[column + 1];
  return static_cast<int>(std::lower_bound(first, last, row) - rows);
}

}  // namespace suffuse

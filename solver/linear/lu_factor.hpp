#pragma once

/// Direct factors of a sparse matrix that is not symmetric but has a symmetric pattern.

#include <Eigen/SparseCore>
#include <vector>

namespace suffuse {

/// A = L U without exchange of rows, for matrices that are close to positive definite ones, as
/// tangents of flow and of soil: unknowns keep the order of approximate minimum degree, and L and U
/// the pattern of a Cholesky factor. It is made row by row along the elimination tree (Davis,
/// Direct Methods for Sparse Linear Systems, SIAM (2006), chapter 4), of L and of U at once.
/// Eigen's SparseLU, which exchanges rows and has another pattern for it, takes six to eight times
/// as long in two dimensions (docs/develop/decisions.md has the numbers).
class LuFactor {
 public:
  /// Orders the unknowns of matrices with this pattern; does nothing if that is done. Throws
  /// NumericalError if the pattern is not symmetric.
  void analyse(const Eigen::SparseMatrix<double>& matrix);

  /// Makes the factors of a matrix, with one pattern in all calls, of which all entries
  /// are stored on both sides of the diagonal. Throws NumericalError if a pivot is zero or not
  /// finite.
  void factorise(const Eigen::SparseMatrix<double>& matrix);

  /// Sets x to the solution with the factors; the caller checks its residual, as pivots may be
  /// small.
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) const;

  /// Multiplications that one factorisation takes over those of one solution.
  [[nodiscard]] double effort() const { return effort_; }

 private:
  /// Entry of L below the diagonal of a column, and the entry of U at its transposed place.
  using Pair = Eigen::Array2d;
  /// An entry left of the diagonal, and where its value and that of its transposed place are among
  /// the values of the matrix.
  struct Entry {
    int column = 0;
    int lower = 0;
    int upper = 0;
  };

  /// Entries of the matrices.
  [[nodiscard]] Eigen::Index stored() const {
    return static_cast<Eigen::Index>(2 * entries_.size() + diagonal_.size());
  }
  void order(const Eigen::SparseMatrix<double>& matrix);
  void find_pattern();

  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> place_;  ///< of each unknown
  std::vector<int> first_entry_;   ///< per row, in `entries_`, and their end
  std::vector<Entry> entries_;     ///< by row, then column
  std::vector<int> diagonal_;      ///< per row: its place among the values of the matrix
  std::vector<int> parent_;        ///< of each column in the elimination tree; -1: none
  std::vector<int> first_factor_;  ///< per column of L, in `row_` and `factor_`, and their end
  std::vector<int> row_;
  std::vector<Pair> factor_;
  std::vector<double> pivot_;
  double effort_ = 0.0;
};

}  // namespace suffuse

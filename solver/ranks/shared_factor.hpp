#pragma once

/// What solves systems of equations whose rows are shared by ranks.

#include <vector>

namespace suffuse {

/// The rows of a sparse matrix that a rank owns: in compressed form, with the numbers that columns
/// have in the whole matrix.
struct OwnMatrixRows {
  long whole = 0;  ///< rows of the whole matrix
  std::vector<int> begin;
  std::vector<long> column;
  std::vector<double> value;

  [[nodiscard]] int count() const { return static_cast<int>(begin.size()) - 1; }
};

/// An approximate inverse of a symmetric positive definite matrix. All ranks have to make the same
/// calls.
class SharedFactor {
 public:
  SharedFactor() = default;
  virtual ~SharedFactor() = default;
  SharedFactor(const SharedFactor&) = delete;
  SharedFactor& operator=(const SharedFactor&) = delete;

  virtual void factorise(const OwnMatrixRows& rows) = 0;
  /// Sets `x` to the solution of matrix x = `rhs`, both per own row, with an error a million times
  /// smaller than the solution, in the norm of the energy. Returns the number of iterations. Throws
  /// NumericalError.
  virtual int solve(const std::vector<double>& rhs, std::vector<double>& x) = 0;
};

}  // namespace suffuse

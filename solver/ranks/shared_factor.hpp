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

/// An approximate inverse of a symmetric positive definite matrix, for systems with it and for
/// those with a matrix near it. All ranks have to make the same calls.
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
  /// Sets `x` to the solution of tangent x = `rhs`, until the residual is 1e-9 of `rhs`. The
  /// tangent need not be symmetric; it has the rows of the matrix that was factored last.
  virtual int solve_near(const OwnMatrixRows& tangent, const std::vector<double>& rhs,
                         std::vector<double>& x) = 0;
};

}  // namespace suffuse

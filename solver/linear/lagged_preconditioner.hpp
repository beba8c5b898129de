#pragma once

/// Solves a sequence of similar symmetric positive definite systems with as few factorisations as
/// it takes.

#include <Eigen/SparseCore>
#include <vector>

#include "linear/supernodal_factor.hpp"
#include "results/state_archive.hpp"

namespace suffuse {

/// What the linear systems of a run took.
struct SolveCounts {
  static constexpr bool has_no_gaps = true;  ///< see StateArchive
  long factorisations = 0;
  long solves = 0;
  long iterations = 0;  ///< of conjugate gradients
};

/// Keeps the factor of one matrix and the values it belongs to. A matrix with the same values is
/// solved with it directly; one that has changed, by conjugate gradients preconditioned with it;
/// one that has changed so much that these need more than `most_iterations`, or would by their pace
/// after a third of them, or one that comes again and again, with a new factor.
class LaggedPreconditioner {
 public:
  static constexpr int most_iterations = 15;
  /// After a solution that took more than this many the next changed matrix is factored at once:
  /// a factorisation costs about ten iterations, and matrices that drift drift on.
  static constexpr int tiring_iterations = 7;

  /// Iterations on one and the same matrix after which it is factored: by then that would have been
  /// cheaper, and what came so often is likely to come again.
  static constexpr int worth_a_factor = 10;

  /// Orders and analyses the pattern (approximate minimum degree), which every matrix given to
  /// `solve` must have. Both triangles are stored.
  explicit LaggedPreconditioner(const Eigen::SparseMatrix<double>& pattern, int threads = 1);

  /// Solution of matrix x = rhs. Iterations begin at `guess` and end when each row's residual is
  /// within `tolerance` (per row, in the unit of `rhs`) or within the round-off of computing it.
  /// Throws NumericalError when the matrix is not positive definite or not finite.
  Eigen::VectorXd solve(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
                        const Eigen::VectorXd& guess, const Eigen::VectorXd& tolerance);

  [[nodiscard]] const SolveCounts& counts() const { return counts_; }

  /// Which matrix is held decides how the next ones are solved. Its factor is made again, of the
  /// same values and thus with the same bits; `pattern` is that of the constructor.
  void archive(StateArchive& archive, const Eigen::SparseMatrix<double>& pattern);

 private:
  void factorise(const Eigen::SparseMatrix<double>& matrix);
  void find_residual(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
                     const Eigen::VectorXd& x, Eigen::VectorXd& residual) const;
  /// Residual per row that is small enough: `tolerance`, or what double precision cannot tell from
  /// nothing, as a row's terms are as large as its diagonal times the largest unknown.
  void find_allowed(const Eigen::VectorXd& rhs, const Eigen::VectorXd& x,
                    const Eigen::VectorXd& tolerance, Eigen::VectorXd& allowed) const;
  /// Largest residual over `share` of what is allowed; infinite where a residual is no number, or
  /// nothing is allowed and something left.
  [[nodiscard]] double excess(const Eigen::VectorXd& residual, const Eigen::VectorXd& allowed,
                              double share) const;
  [[nodiscard]] bool is_factored(const Eigen::SparseMatrix<double>& matrix) const;
  [[nodiscard]] Eigen::VectorXd solve_directly(const Eigen::SparseMatrix<double>& matrix,
                                               const Eigen::VectorXd& rhs,
                                               const Eigen::VectorXd& tolerance);
  /// Improves `x`; whether it got there in time.
  bool iterate(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
               const Eigen::VectorXd& tolerance, Eigen::VectorXd& x);

  int threads_;
  ReleasableLdlt factor_;
  SupernodalFactor packed_;   ///< what it came to
  Eigen::VectorXd diagonal_;  ///< of the matrix being solved
  // Of the iterations; kept, so that they allocate nothing.
  Eigen::VectorXd residual_, allowed_, preconditioned_, direction_, image_;
  std::vector<double> factored_values_;
  long last_iterations_ = 0;
  std::vector<double> iterated_values_;  ///< of the matrix last solved by iterations
  long spent_ = 0;                       ///< iterations on it so far
  SolveCounts counts_;
};

}  // namespace suffuse

#pragma once

/// Solves a sequence of similar symmetric positive definite systems with few factorizations.

#include <Eigen/SparseCore>
#include <algorithm>
#include <memory>
#include <vector>

#include "linear/cholesky_factor.hpp"
#include "linear/conjugate_gradients.hpp"

namespace suffuse {

/// Counts of the linear solutions of a run.
struct SolveCounts {
  static constexpr bool has_no_gaps = true;  ///< see StateArchive
  long factorisations = 0;
  long solves = 0;
  long iterations = 0;  ///< of conjugate gradients

  SolveCounts& operator+=(const SolveCounts& more) {
    factorisations += more.factorisations;
    solves += more.solves;
    iterations += more.iterations;
    return *this;
  }
};

/// Whether multigrid is better for the flow on a mesh than a direct factor: in three dimensions
/// from 30 000 faces on (docs/develop/decisions.md has the numbers).
constexpr bool prefers_multigrid(int dimension, int faces) {
  return dimension == 3 && faces >= 30'000;
}
/// The factor for the flow on such a mesh.
std::unique_ptr<Factor> flow_factor(int dimension, int faces);
/// The factor for systems of Newton's method on such a mesh, whose matrix changes each time.
std::unique_ptr<Factor> newton_factor(int dimension, int faces);

/// Limits beyond which a changed matrix is factored anew. That costs about ten iterations.
struct LagLimits {
  /// Limits of one solution: if it takes more, or is too slow, the matrix is factored.
  IterationLimits solution;
  /// After a solution with more iterations than this the next changed matrix is factored at once,
  /// as matrices that drift continue to drift.
  int tiring_iterations = 7;
  /// A matrix that has taken this number of iterations, for several right-hand sides, is factored,
  /// as it is likely to come again.
  int repeated_iterations = 10;
};

/// Keeps the factor of one matrix and its values. A matrix with these values is solved with it
/// directly; one that has changed, by conjugate gradients preconditioned with it, until LagLimits
/// say that a new factor is cheaper.
class LaggedPreconditioner {
 public:
  explicit LaggedPreconditioner(
      int threads = 1, LagLimits limits = {},
      std::unique_ptr<Factor> factor = std::make_unique<CholeskyFactor>());

  /// Solution of a system, within its tolerance or the round-off of computing a residual. A direct
  /// solution that misses this is refined once; an inexact factor serves as preconditioner. The
  /// pattern of the matrix is the same in every call. Throws NumericalError if the matrix is not
  /// positive definite or not finite, or if iterations do not converge.
  Eigen::VectorXd solve(const SymmetricSystem& system);

  [[nodiscard]] const SolveCounts& counts() const { return counts_; }

  /// The factored matrix decides how later ones are solved. Its factor is made again from its
  /// values, with the same bits; `pattern` is that of the matrices. Without `is_used` what is
  /// restored is dropped.
  void archive(auto& archive, const Eigen::SparseMatrix<double>& pattern, bool is_used = true) {
    std::vector<double> factored = factored_values_;
    archive(factored, iterated_values_);
    if (archive.restores()) {
      factored_values_.clear();
      if (!is_used) iterated_values_.clear();
      if (is_used && !factored.empty()) {
        Matrix matrix = pattern;
        if (factored.size() != static_cast<std::size_t>(matrix.nonZeros())) archive.misfit();
        std::copy(factored.begin(), factored.end(), matrix.valuePtr());
        factorise(matrix);
      }
    }
    archive(last_iterations_, repeated_iterations_, counts_);
  }

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  void factorise(const Matrix& matrix);
  [[nodiscard]] Eigen::VectorXd solve_directly(const SymmetricSystem& system);
  /// Solves with an exact factor of the matrix, and refines the solution once if need be.
  [[nodiscard]] Eigen::VectorXd refined_solution(Factor& exact, const SymmetricSystem& system);
  /// Improves `x` by iterations with the factor of an earlier matrix. Returns whether it is solved.
  bool solve_by_iterations(const SymmetricSystem& system, Eigen::VectorXd& x);

  LagLimits limits_;
  std::unique_ptr<Factor> factor_;
  ConjugateGradients conjugate_gradients_;
  ConjugateGradients patient_gradients_;  ///< with an inexact factor of the matrix itself
  Residual residual_;
  Eigen::VectorXd correction_;
  std::vector<double> factored_values_;  ///< empty if there is no factor
  std::vector<double> iterated_values_;  ///< of the matrix last solved by iterations
  long last_iterations_ = 0;             ///< of the last solution by iterations
  long repeated_iterations_ = 0;         ///< on the matrix of `iterated_values_`
  SolveCounts counts_;
};

}  // namespace suffuse

#pragma once

/// Conjugate gradients (Hestenes and Stiefel, J. Res. Natl. Bur. Stand. 49 (1952) 409),
/// preconditioned with the factor of a similar matrix; flexible if the factor is not exact (Notay,
/// SIAM J. Sci. Comput. 22 (2000) 1444).

#include "linear/factor.hpp"
#include "linear/symmetric_system.hpp"

namespace suffuse {

/// Limits beyond which iterations are given up.
struct IterationLimits {
  int max_iterations = 15;
  /// After this number of iterations at least the share `min_progress` of the digits needed must be
  /// gained: half of what an even pace gives.
  int pace_iterations = max_iterations / 3;
  double min_progress = 1.0 / 6.0;
};

class ConjugateGradients {
 public:
  explicit ConjugateGradients(int threads, IterationLimits limits = {})
      : threads_(threads), limits_(limits), residual_(threads) {}

  /// Improves `x` until each row's residual is allowed (see Residual). Returns whether it succeeded
  /// within the limits; if not, `x` is not usable.
  bool solve(const SymmetricSystem& system, Factor& preconditioner, Eigen::VectorXd& x);

  /// Iterations of the last call of `solve`.
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  /// Iterates until the updated residual is half of what is allowed.
  bool iterate(const SymmetricSystem& system, Factor& preconditioner, Eigen::VectorXd& x);

  int threads_;
  IterationLimits limits_;
  int iterations_ = 0;
  double first_excess_ = 0.0;
  // Members, so that iterations do not allocate.
  Residual residual_;
  Eigen::VectorXd preconditioned_, direction_, image_, earlier_;
};

}  // namespace suffuse

#pragma once

/// Multigrid by aggregation (Notay, Electron. Trans. Numer. Anal. 37 (2010) 123), for large systems
/// in three dimensions, whose direct factor takes too much time and memory.

#include <memory>
#include <vector>

#include "linear/cholesky_factor.hpp"

namespace suffuse {

/// Each level joins up to four unknowns of the one above, those with the strongest couplings; the
/// coarsest is factored. One solution is a cycle: Gauss-Seidel forward and backward, and two steps
/// of conjugate gradients on each coarse level, so that it is efficient with any number of levels
/// and any contrast of conductivities. It only approximates matrix^-1 rhs.
class Multigrid final : public Factor {
 public:
  void factorise(const Eigen::SparseMatrix<double>& matrix) override;
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) override;
  [[nodiscard]] bool is_exact() const override { return false; }

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  struct Level {
    Matrix matrix;
    std::vector<int> aggregate;  ///< of each unknown: its unknown in the next level
    Eigen::VectorXd diagonal;
    Eigen::VectorXd rhs, x, residual, direction, image, second, second_image;
  };

  void smooth(const Level& level, const Eigen::VectorXd& rhs, bool forward,
              Eigen::VectorXd& x) const;
  /// One cycle from level `number` on, into x.
  void cycle(std::size_t number, const Eigen::VectorXd& rhs, Eigen::VectorXd& x);
  /// Two steps of conjugate gradients with `levels_[number].rhs`, into its x.
  void solve_coarse(std::size_t number);

  std::vector<Level> levels_;
  std::unique_ptr<CholeskyFactor> coarsest_;
};

}  // namespace suffuse

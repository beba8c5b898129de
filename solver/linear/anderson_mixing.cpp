#include "linear/anderson_mixing.hpp"

#include <cmath>

namespace suffuse {

Eigen::VectorXd AndersonMixing::next(const Eigen::VectorXd& x, const Eigen::VectorXd& g) {
  const Eigen::VectorXd residual = g - x;
  if (std::exchange(has_last_, true)) {
    changes_of_g_.emplace_back(g - last_g_);
    changes_of_residual_.emplace_back(residual - last_residual_);
    if (static_cast<int>(changes_of_g_.size()) > depth_) {
      changes_of_g_.erase(changes_of_g_.begin());
      changes_of_residual_.erase(changes_of_residual_.begin());
    }
  }
  last_g_ = g;
  last_residual_ = residual;
  const auto count = static_cast<Eigen::Index>(changes_of_g_.size());
  if (count == 0) return g;
  // Least squares of the residual by its changes, by modified Gram-Schmidt. Eigen's QR is not used:
  // Gmsh brings its own copy of that, built for another processor.
  std::vector<Eigen::VectorXd> basis;
  std::vector<Eigen::VectorXd> basis_of_g;
  Eigen::VectorXd result = g;
  Eigen::VectorXd left = residual;
  constexpr double dependent = 1e-12;
  for (Eigen::Index i = count - 1; i >= 0; --i) {
    Eigen::VectorXd direction = changes_of_residual_[i];
    Eigen::VectorXd change = changes_of_g_[i];
    const double whole = std::sqrt(dot_(direction, direction));
    for (std::size_t k = 0; k < basis.size(); ++k) {
      const double share = dot_(basis[k], direction);
      direction -= share * basis[k];
      change -= share * basis_of_g[k];
    }
    const double size = std::sqrt(dot_(direction, direction));
    if (!(size > dependent * whole)) continue;
    basis.emplace_back(direction / size);
    basis_of_g.emplace_back(change / size);
    const double weight = dot_(basis.back(), left);
    left -= weight * basis.back();
    result -= weight * basis_of_g.back();
  }
  return result;
}

}  // namespace suffuse

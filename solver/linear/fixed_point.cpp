#include "linear/fixed_point.hpp"

#include <Eigen/QR>

namespace suffuse {

Eigen::VectorXd AndersonMixing::next(const Eigen::VectorXd& x, const Eigen::VectorXd& g) {
  const Eigen::VectorXd residual = g - x;
  if (last_g_.size() > 0) {
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
  Eigen::MatrixXd changes(g.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) changes.col(i) = changes_of_residual_[i];
  const Eigen::VectorXd weights = changes.colPivHouseholderQr().solve(residual);
  Eigen::VectorXd result = g;
  for (Eigen::Index i = 0; i < count; ++i) result -= weights[i] * changes_of_g_[i];
  return result;
}

}  // namespace suffuse

#include "flow/anderson.hpp"

namespace suffuse {

Eigen::VectorXd AndersonMixing::next(const Eigen::VectorXd& g, const Eigen::VectorXd& residual,
                                     const Eigen::VectorXd& weight) {
  const auto columns = static_cast<Eigen::Index>(residuals_.size());
  Eigen::VectorXd result = g;
  if (columns > 0) {
    Eigen::MatrixXd change(g.size(), columns);
    for (Eigen::Index j = 0; j < columns; ++j) {
      change.col(j) = weight.cwiseProduct(residual - residuals_[j]);
    }
    const Eigen::VectorXd share = change.colPivHouseholderQr().solve(weight.cwiseProduct(residual));
    for (Eigen::Index j = 0; j < columns; ++j) result -= share[j] * (g - results_[j]);
  }
  residuals_.push_back(residual);
  results_.push_back(g);
  if (residuals_.size() > depth) {
    residuals_.pop_front();
    results_.pop_front();
  }
  return result;
}

}  // namespace suffuse

#include "flow/anderson.hpp"

namespace suffuse {

Eigen::VectorXd AndersonMixing::next(const Eigen::VectorXd& g, const Eigen::VectorXd& residual,
                                     const Eigen::VectorXd& weight, double share) {
  const auto columns = static_cast<Eigen::Index>(residuals_.size());
  Eigen::VectorXd result = g;
  Eigen::VectorXd left = residual;
  if (columns > 0) {
    Eigen::MatrixXd change(g.size(), columns);
    for (Eigen::Index j = 0; j < columns; ++j) {
      change.col(j) = weight.cwiseProduct(residual - residuals_[j]);
    }
    const Eigen::VectorXd part = change.colPivHouseholderQr().solve(weight.cwiseProduct(residual));
    for (Eigen::Index j = 0; j < columns; ++j) {
      result -= part[j] * (g - results_[j]);
      left -= part[j] * (residual - residuals_[j]);
    }
  }
  result -= (1.0 - share) * left;
  residuals_.push_back(residual);
  results_.push_back(g);
  if (residuals_.size() > depth) {
    residuals_.pop_front();
    results_.pop_front();
  }
  return result;
}

}  // namespace suffuse

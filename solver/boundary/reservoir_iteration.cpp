#include "boundary/reservoir_iteration.hpp"

#include <cmath>

namespace suffuse {

bool ReservoirIteration::agree(std::vector<double>& rates, const std::vector<double>& of_flow) {
  const Eigen::VectorXd tried = Eigen::Map<const Eigen::VectorXd>(rates.data(), std::ssize(rates));
  const Eigen::VectorXd found =
      Eigen::Map<const Eigen::VectorXd>(of_flow.data(), std::ssize(of_flow));
  if (tried.size() == 0 || (found - tried).cwiseAbs().maxCoeff() <= tolerance_) return true;
  const Eigen::VectorXd next = mixing_.next(tried, found);
  rates.assign(next.begin(), next.end());
  return false;
}

}  // namespace suffuse

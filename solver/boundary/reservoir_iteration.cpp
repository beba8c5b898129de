#include "boundary/reservoir_iteration.hpp"

#include <cmath>

namespace suffuse {
namespace {

/// Levels agree when they differ by less than this share of the scale of heads.
constexpr double accuracy = 1e-10;
/// Levels follow the flow when they differ by less than this share.
constexpr double far = 0.05;

}  // namespace

bool ReservoirIteration::agree(std::vector<double>& rates, const std::vector<double>& of_flow) {
  const Eigen::VectorXd tried = Eigen::Map<const Eigen::VectorXd>(rates.data(), std::ssize(rates));
  const Eigen::VectorXd found =
      Eigen::Map<const Eigen::VectorXd>(of_flow.data(), std::ssize(of_flow));
  if (tried.size() == 0 || (found - tried).cwiseAbs().maxCoeff() <= accuracy * scale_) return true;
  const Eigen::VectorXd next = mixing_.next(tried, found);
  rates.assign(next.begin(), next.end());
  return false;
}

bool ReservoirIteration::follow(const std::vector<double>& rates, std::size_t stages) const {
  const std::size_t reservoirs = rates.size() / stages;
  for (std::size_t i = reservoirs; i < rates.size(); ++i) {
    if (std::abs(rates[i] - rates[i - reservoirs]) > far * scale_) return false;
  }
  return true;
}

}  // namespace suffuse

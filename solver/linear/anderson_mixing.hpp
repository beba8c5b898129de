#pragma once

/// Acceleration of a slowly converging iteration x -> g(x) (Anderson 1965; Walker and Ni, SIAM J.
/// Numer. Anal. 49 (2011) 1715). If g is linear this is GMRES.

#include <Eigen/Core>
#include <vector>

namespace suffuse {

class AndersonMixing {
 public:
  /// Uses the last `depth` iterations.
  explicit AndersonMixing(int depth) : depth_(depth) {}

  /// Next x of the iteration, from x and g(x).
  [[nodiscard]] Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& g);

 private:
  int depth_;
  Eigen::VectorXd last_g_;
  Eigen::VectorXd last_residual_;
  std::vector<Eigen::VectorXd> changes_of_g_;
  std::vector<Eigen::VectorXd> changes_of_residual_;
};

}  // namespace suffuse

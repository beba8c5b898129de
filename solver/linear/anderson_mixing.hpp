#pragma once

/// Acceleration of a slowly converging iteration x -> g(x) (Anderson 1965; Walker and Ni, SIAM J.
/// Numer. Anal. 49 (2011) 1715). If g is linear this is GMRES.

#include <Eigen/Core>
#include <functional>
#include <utility>
#include <vector>

namespace suffuse {

class AndersonMixing {
 public:
  using Dot = std::function<double(const Eigen::VectorXd&, const Eigen::VectorXd&)>;

  /// Uses the last `depth` iterations. `dot`: the scalar product; with one over all ranks, each
  /// rank may have a part of x.
  explicit AndersonMixing(int depth, Dot dot = of_whole) : depth_(depth), dot_(std::move(dot)) {}

  /// Next x of the iteration, from x and g(x).
  [[nodiscard]] Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& g);

 private:
  static double of_whole(const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return a.dot(b); }

  int depth_;
  Dot dot_;
  bool has_last_ = false;
  Eigen::VectorXd last_g_;
  Eigen::VectorXd last_residual_;
  std::vector<Eigen::VectorXd> changes_of_g_;
  std::vector<Eigen::VectorXd> changes_of_residual_;
};

}  // namespace suffuse

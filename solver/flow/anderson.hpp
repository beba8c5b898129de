#pragma once

/// Anderson's mixing (J. ACM 12 (1965) 547; Walker and Ni, SIAM J. Numer. Anal. 49 (2011) 1715)
/// speeds up a fixed-point iteration x -> G(x): the next x is the combination of the last results
/// whose residuals G(x) - x cancel best.

#include <Eigen/Dense>
#include <deque>

namespace suffuse {

class AndersonMixing {
 public:
  /// Forgets what came before: a new problem, or one that has changed.
  void reset() {
    residuals_.clear();
    results_.clear();
  }

  /// The next x after the result `g` with the residual `residual` = g - x, both weighted alike by
  /// `weight` for the least squares. Of the residual that is left, it takes this share: the first
  /// after a reset is x + share (g - x).
  Eigen::VectorXd next(const Eigen::VectorXd& g, const Eigen::VectorXd& residual,
                       const Eigen::VectorXd& weight, double share = 1.0);

 private:
  static constexpr std::size_t depth = 4;

  std::deque<Eigen::VectorXd> residuals_;
  std::deque<Eigen::VectorXd> results_;
};

}  // namespace suffuse

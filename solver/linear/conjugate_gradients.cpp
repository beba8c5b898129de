#include "linear/conjugate_gradients.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "grid/parallel.hpp"

namespace suffuse {
namespace {

/// Sum of products in blocks of fixed size: the same bits on any number of threads.
double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int threads) {
  constexpr int block = 4096;
  const auto size = static_cast<int>(a.size());
  const int blocks = (size + block - 1) / block;
  std::vector<double> part(blocks);
  const auto add_up = [&](int i) {
    const int begin = i * block;
    const int length = std::min(block, size - begin);
    part[i] = a.segment(begin, length).dot(b.segment(begin, length));
  };
  for_each_index(blocks, size >= worth_threads ? threads : 1, add_up, 1);
  return std::accumulate(part.begin(), part.end(), 0.0);
}

}  // namespace

bool ConjugateGradients::solve(const SymmetricSystem& system, Factor& preconditioner,
                               Eigen::VectorXd& x) {
  iterations_ = 0;
  // Iterations update the residual instead of computing it. Start again from the true residual if
  // the two have drifted apart.
  while (true) {
    residual_.compute(system, x);
    if (residual_.is_allowed()) return true;
    if (iterations_ == limits_.max_iterations) return false;
    if (!iterate(system, preconditioner, x)) return false;
  }
}

bool ConjugateGradients::iterate(const SymmetricSystem& system, Factor& preconditioner,
                                 Eigen::VectorXd& x) {
  const auto rows = static_cast<int>(x.size());
  const bool flexible = !preconditioner.is_exact();
  double last_product = 0.0;
  for (; iterations_ < limits_.max_iterations; ++iterations_) {
    const double excess = 2.0 * residual_.excess();
    if (excess <= 1.0) return true;
    if (iterations_ == 0) first_excess_ = excess;
    if (iterations_ == limits_.pace_iterations &&
        std::log(first_excess_ / excess) < limits_.min_progress * std::log(first_excess_)) {
      return false;
    }
    preconditioner.solve(residual_.values, preconditioned_);
    const double product = dot(residual_.values, preconditioned_, threads_);
    if (last_product == 0.0) {
      direction_ = preconditioned_;
    } else {
      // A nonlinear factor does not keep its result orthogonal to the earlier residual.
      const double fresh = product - (flexible ? dot(earlier_, preconditioned_, threads_) : 0.0);
      const double share = fresh / last_product;
      for_each_index(rows, threads_,
                     [&](int i) { direction_[i] = preconditioned_[i] + share * direction_[i]; });
    }
    last_product = product;
    multiply(system.matrix, direction_, threads_, image_);
    const double curvature = dot(direction_, image_, threads_);
    if (!(product > 0.0 && curvature > 0.0)) return false;
    const double length = product / curvature;
    if (flexible) earlier_ = residual_.values;
    for_each_index(rows, threads_, [&](int i) {
      x[i] += length * direction_[i];
      residual_.values[i] -= length * image_[i];
    });
  }
  return true;
}

}  // namespace suffuse

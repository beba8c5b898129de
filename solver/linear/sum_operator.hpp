#pragma once

/// A sparse matrix plus a linear map that has none, for the iterations of Eigen.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>

namespace suffuse {

/// A linear map of vectors of unknowns.
using LinearMap = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

class SumOperator;

}  // namespace suffuse

namespace Eigen::internal {

template <>
struct traits<suffuse::SumOperator> : traits<SparseMatrix<double>> {};

}  // namespace Eigen::internal

namespace suffuse {

/// Keeps references. The interface is that of Eigen's matrix-free solvers.
class SumOperator : public Eigen::EigenBase<SumOperator> {
 public:
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum : int {
    ColsAtCompileTime = Eigen::Dynamic,
    MaxColsAtCompileTime = Eigen::Dynamic,
    IsRowMajor = 0
  };

  SumOperator(const Eigen::SparseMatrix<double>& matrix, const LinearMap& more)
      : matrix_(matrix), more_(more) {}

  [[nodiscard]] Eigen::Index rows() const { return matrix_.rows(); }
  [[nodiscard]] Eigen::Index cols() const { return matrix_.cols(); }
  template <class Rhs>
  auto operator*(const Eigen::MatrixBase<Rhs>& x) const {
    return Eigen::Product<SumOperator, Rhs, Eigen::AliasFreeProduct>(*this, x.derived());
  }
  [[nodiscard]] Eigen::VectorXd times(const Eigen::VectorXd& x) const {
    return matrix_ * x + more_(x);
  }

 private:
  const Eigen::SparseMatrix<double>& matrix_;
  const LinearMap& more_;
};

}  // namespace suffuse

namespace Eigen::internal {

template <class Rhs>
struct generic_product_impl<suffuse::SumOperator, Rhs, SparseShape, DenseShape, GemvProduct>
    : generic_product_impl_base<suffuse::SumOperator, Rhs,
                                generic_product_impl<suffuse::SumOperator, Rhs>> {
  using Scalar = double;

  template <class Result>
  static void scaleAndAddTo(Result& result, const suffuse::SumOperator& sum, const Rhs& x,
                            const double& factor) {
    result += factor * sum.times(x);
  }
};

}  // namespace Eigen::internal

/// Direct factors of unsymmetric matrices, against Eigen's.

#include "linear/lu_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/SparseLU>
#include <cmath>

#include "common/errors.hpp"
#include "linear/newton_system.hpp"

namespace suffuse {
namespace lu_factor_test {

using Matrix = Eigen::SparseMatrix<double>;

/// Couplings of neighbours and diagonal ones on a square of n x n unknowns: symmetric, and to one
/// side only as strongly as `drift`.
Matrix drifting(int n, double drift) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto couple = [&](int a, int b, double weight, double wind) {
    entries.emplace_back(a, a, weight);
    entries.emplace_back(b, b, weight);
    entries.emplace_back(a, b, -weight + wind);
    entries.emplace_back(b, a, -weight - wind);
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * n + j;
      entries.emplace_back(a, a, 0.01);
      if (i + 1 < n) couple(a, a + n, 1.0, drift);
      if (j + 1 < n) couple(a, a + 1, 1.0 + 0.5 * std::sin(a), -0.7 * drift);
      if (i + 1 < n && j + 1 < n) couple(a, a + n + 1, 0.2, 0.3 * drift);
    }
  }
  const int size = n * n;
  Matrix result(size, size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

class LuFactorOf : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Drifts, LuFactorOf, testing::Values(0.0, 0.5, 1.0, 10.0));

TEST_P(LuFactorOf, GivesTheSolutionOfEigensSparseLu) {
  const Matrix matrix = drifting(40, GetParam());
  const Eigen::VectorXd rhs = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 2.0);
  LuFactor factor;
  factor.factorise(drifting(40, 0.3));  // the pattern stays
  factor.factorise(matrix);
  Eigen::VectorXd x;
  factor.solve(rhs, x);
  Eigen::SparseLU<Matrix> exact(matrix);
  const Eigen::VectorXd expected = exact.solve(rhs);
  EXPECT_LE((x - expected).norm(), 1e-10 * expected.norm());
  EXPECT_LE((matrix * x - rhs).norm(), 1e-11 * rhs.norm());
}

/// A full matrix of n unknowns: n (n - 1) / 2 entries in columns of 0 to n - 1.
TEST(LuFactor, KnowsItsEffort) {
  constexpr int n = 10;
  LuFactor factor;
  factor.analyse((Eigen::MatrixXd::Identity(n, n) + Eigen::MatrixXd::Ones(n, n)).sparseView());
  EXPECT_NEAR(factor.effort(), (n - 1) * n * (2 * n - 1) / 6.0 / (n * (n - 1)), 1e-12);
}

TEST(LuFactor, RefusesWhatItCannotSolve) {
  Matrix matrix = drifting(5, 0.1);
  LuFactor factor;
  matrix.coeffRef(3, 20) = 1.0;
  EXPECT_THROW(factor.factorise(matrix), NumericalError);
  EXPECT_THROW(factor.factorise(matrix.transpose()), NumericalError);
  EXPECT_THROW(factor.factorise(Eigen::MatrixXd{{0.0, 1.0}, {1.0, 0.0}}.sparseView()),
               NumericalError);
  Eigen::MatrixXd singular = Eigen::MatrixXd::Ones(3, 3);
  EXPECT_THROW(LuFactor().factorise(singular.sparseView()), NumericalError);
  singular(1, 1) = std::nan("");
  EXPECT_THROW(LuFactor().factorise(singular.sparseView()), NumericalError);
}

/// The rows add up to 1e-6 of what couples the unknowns, so all are 1; round-off of the residual is
/// 1e-5 of the right-hand side.
TEST(NewtonSystem, TakesSolutionsUpToRoundOff) {
  Matrix matrix = 1e4 * drifting(40, 0.0);
  for (int i = 0; i < matrix.rows(); ++i) matrix.coeffRef(i, i) += 1e-6 - 1e4 * 0.01;
  const Eigen::VectorXd rhs = Eigen::VectorXd::Constant(matrix.rows(), 1e-6);
  Eigen::VectorXd x;
  NewtonSystem().solve_tangent(matrix, matrix, rhs, x);
  EXPECT_GT((matrix * x - rhs).norm(), 1e-9 * rhs.norm());
  EXPECT_LE((x.array() - 1.0).abs().maxCoeff(), 1e-3);
}

/// Iterations find what is near the symmetric matrix; what is not costs them once.
TEST(NewtonSystem, GoesOnDirectlyWhereIterationsFail) {
  const Matrix nearly = drifting(40, 0.0);
  const Matrix near = drifting(40, 1e-5);
  const Matrix far = drifting(40, 10.0);
  const Eigen::VectorXd rhs = Eigen::VectorXd::LinSpaced(nearly.rows(), -1.0, 2.0);
  Eigen::VectorXd x;
  NewtonSystem system;
  system.factorise(nearly);
  system.solve(near, rhs, x);
  EXPECT_LE((near * x - rhs).norm(), 1e-9 * rhs.norm());
  EXPECT_EQ(system.counts().factorisations, 1);
  system.solve(far, rhs, x);
  EXPECT_LE((far * x - rhs).norm(), 1e-9 * rhs.norm());
  EXPECT_EQ(system.counts().factorisations, 2);
  const long iterations = system.counts().iterations;
  system.solve(far, rhs, x);
  EXPECT_EQ(system.counts().iterations, iterations);
  system.iterate_again();
  system.solve(near, rhs, x);
  EXPECT_GT(system.counts().iterations, iterations);
  EXPECT_EQ(system.counts().factorisations, 3);
}

}  // namespace lu_factor_test
}  // namespace suffuse

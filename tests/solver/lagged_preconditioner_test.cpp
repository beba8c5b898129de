#include "linear/lagged_preconditioner.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "case/errors.hpp"

namespace suffuse {
namespace {

/// Five-point matrix of flow on an n x n grid, conductances 1 + amount * (something between -1 and
/// 1 that depends on place), grounded on one side.
Eigen::SparseMatrix<double> flow_matrix(int n, double amount) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto connect = [&](int a, int b, double conductance) {
    entries.emplace_back(a, a, conductance);
    entries.emplace_back(b, b, conductance);
    entries.emplace_back(a, b, -conductance);
    entries.emplace_back(b, a, -conductance);
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double conductance = 1.0 + amount * std::sin(12.9 * i + 78.2 * j);
      if (i + 1 < n) connect(i * n + j, (i + 1) * n + j, conductance);
      if (j + 1 < n) connect(i * n + j, i * n + j + 1, conductance);
    }
    entries.emplace_back(i, i, 1.0);
  }
  const int size = n * n;
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::VectorXd load(Eigen::Index size) {
  Eigen::VectorXd result(size);
  for (Eigen::Index i = 0; i < size; ++i) result[i] = std::cos(0.37 * static_cast<double>(i));
  return result;
}

double difference_from_dense(const Eigen::SparseMatrix<double>& matrix,
                             const Eigen::VectorXd& solution) {
  const Eigen::VectorXd exact = Eigen::MatrixXd(matrix).ldlt().solve(load(matrix.rows()));
  return (solution - exact).lpNorm<Eigen::Infinity>() / exact.lpNorm<Eigen::Infinity>();
}

class LaggedPreconditionerTest : public ::testing::Test {
 protected:
  static constexpr int n = 15;
  static constexpr Eigen::Index size = 225;  // n * n
  Eigen::VectorXd solve(const Eigen::SparseMatrix<double>& matrix) {
    return held_.solve(matrix, load(size), Eigen::VectorXd::Zero(size),
                       Eigen::VectorXd::Constant(size, 1e-14));
  }
  LaggedPreconditioner held_{flow_matrix(n, 0.0)};
};

TEST_F(LaggedPreconditionerTest, SameMatrixIsFactoredOnce) {
  const auto matrix = flow_matrix(n, 0.2);
  for (int i = 0; i < 3; ++i) EXPECT_LE(difference_from_dense(matrix, solve(matrix)), 1e-12);
  EXPECT_EQ(held_.counts().factorisations, 1);
  EXPECT_EQ(held_.counts().solves, 3);
  EXPECT_EQ(held_.counts().iterations, 0);
}

TEST_F(LaggedPreconditionerTest, MatrixThatDriftedIsSolvedByIterations) {
  solve(flow_matrix(n, 0.2));
  const auto drifted = flow_matrix(n, 0.21);
  EXPECT_LE(difference_from_dense(drifted, solve(drifted)), 1e-12);
  EXPECT_EQ(held_.counts().factorisations, 1);
  EXPECT_GE(held_.counts().iterations, 3);
  EXPECT_LE(held_.counts().iterations, 10);
  RecordProperty("iterations_drift_1_percent", static_cast<int>(held_.counts().iterations));
}

TEST_F(LaggedPreconditionerTest, AGoodGuessSavesIterations) {
  solve(flow_matrix(n, 0.2));
  const auto drifted = flow_matrix(n, 0.21);
  const Eigen::VectorXd x = solve(drifted);
  const long before = held_.counts().iterations;
  held_.solve(drifted, load(size), x, Eigen::VectorXd::Constant(size, 1e-12));
  EXPECT_EQ(held_.counts().iterations, before);
}

TEST_F(LaggedPreconditionerTest, MatrixThatChangedALotIsFactoredAnew) {
  solve(flow_matrix(n, 0.0));
  const auto changed = flow_matrix(n, 0.95);
  EXPECT_LE(difference_from_dense(changed, solve(changed)), 1e-12);
  EXPECT_EQ(held_.counts().factorisations, 2);
  EXPECT_LE(held_.counts().iterations, LaggedPreconditioner::most_iterations);
  solve(changed);
  EXPECT_EQ(held_.counts().factorisations, 2);
}

TEST_F(LaggedPreconditionerTest, AfterATiringSolutionTheNextMatrixIsFactored) {
  solve(flow_matrix(n, 0.0));
  solve(flow_matrix(n, 0.2));
  EXPECT_EQ(held_.counts().factorisations, 1);
  EXPECT_GT(held_.counts().iterations, LaggedPreconditioner::tiring_iterations);
  const long before = held_.counts().iterations;
  const auto next = flow_matrix(n, 0.21);
  EXPECT_LE(difference_from_dense(next, solve(next)), 1e-12);
  EXPECT_EQ(held_.counts().factorisations, 2);
  EXPECT_EQ(held_.counts().iterations, before);
}

TEST_F(LaggedPreconditionerTest, HopelessIterationsEndEarly) {
  solve(flow_matrix(n, 0.0));
  // Grounded a thousand times better everywhere, in places: each is another eigenvalue.
  Eigen::SparseMatrix<double> changed = flow_matrix(n, 0.0);
  for (int i = 0; i < static_cast<int>(size); ++i)
    changed.coeffRef(i, i) += std::pow(10.0, 3.0 * std::sin(7.0 * i));
  EXPECT_LE(difference_from_dense(changed, solve(changed)), 1e-12);
  EXPECT_EQ(held_.counts().factorisations, 2);
  EXPECT_EQ(held_.counts().iterations, LaggedPreconditioner::most_iterations / 3);
}

TEST_F(LaggedPreconditionerTest, RefusesWhatIsNotPositiveDefiniteOrNotFinite) {
  Eigen::SparseMatrix<double> matrix = flow_matrix(n, 0.0);
  matrix.coeffRef(3, 3) = -1.0;
  EXPECT_THROW(solve(matrix), NumericalError);
  matrix.coeffRef(3, 3) = std::nan("");
  EXPECT_THROW(solve(matrix), NumericalError);
  EXPECT_NO_THROW(solve(flow_matrix(n, 0.0)));
}

/// Large enough to be solved in branches.
constexpr int large = 110;

TEST(SupernodalFactor, SolvesAsTheFactorItTook) {
  for (const int side : {1, 7, large}) {
    const Eigen::SparseMatrix<double> matrix = flow_matrix(side, 0.5);
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
    SupernodalFactor packed(1);
    packed.take(factor);
    const Eigen::VectorXd rhs = load(matrix.rows());
    Eigen::VectorXd solution;
    packed.solve(rhs, solution);
    const Eigen::VectorXd expected = factor.solve(rhs);
    EXPECT_LE((solution - expected).lpNorm<Eigen::Infinity>(),
              1e-13 * expected.lpNorm<Eigen::Infinity>())
        << side;
  }
}

TEST(SupernodalFactor, TakesOtherValuesOfTheSamePattern) {
  SupernodalFactor packed(1);
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
  factor.analyzePattern(flow_matrix(large, 0.0));
  for (const double amount : {0.0, 0.9}) {
    const Eigen::SparseMatrix<double> matrix = flow_matrix(large, amount);
    factor.factorize(matrix);
    packed.take(factor);
    Eigen::VectorXd solution;
    packed.solve(load(matrix.rows()), solution);
    EXPECT_LE((matrix * solution - load(matrix.rows())).lpNorm<Eigen::Infinity>(), 1e-11) << amount;
  }
}

TEST(SupernodalFactor, TwoThreadsGiveTheSameBits) {
  const Eigen::SparseMatrix<double> matrix = flow_matrix(large, 0.5);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  const auto solution = [&](int threads) {
    SupernodalFactor packed(threads);
    packed.take(factor);
    Eigen::VectorXd x;
    packed.solve(load(matrix.rows()), x);
    return x;
  };
  EXPECT_EQ(solution(1), solution(2));
}

}  // namespace
}  // namespace suffuse

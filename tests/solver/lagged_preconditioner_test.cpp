#include "linear/lagged_preconditioner.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>

#include "common/errors.hpp"

namespace suffuse {
namespace lagged_preconditioner_test {

/// Five-point matrix of flow on an n x n grid, grounded on one side, with conductances 1 + amount *
/// (a number between -1 and 1 that depends on the place).
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
    return lagged_.solve(
        {matrix, load(size), Eigen::VectorXd::Zero(size), Eigen::VectorXd::Constant(size, 1e-14)});
  }
  LaggedPreconditioner lagged_;
};

TEST_F(LaggedPreconditionerTest, SameMatrixIsFactoredOnce) {
  const auto matrix = flow_matrix(n, 0.2);
  for (int i = 0; i < 3; ++i) EXPECT_LE(difference_from_dense(matrix, solve(matrix)), 1e-12);
  EXPECT_EQ(lagged_.counts().factorisations, 1);
  EXPECT_EQ(lagged_.counts().solves, 3);
  EXPECT_EQ(lagged_.counts().iterations, 0);
}

TEST_F(LaggedPreconditionerTest, MatrixThatDriftedIsSolvedByIterations) {
  solve(flow_matrix(n, 0.2));
  const auto drifted = flow_matrix(n, 0.21);
  EXPECT_LE(difference_from_dense(drifted, solve(drifted)), 1e-12);
  EXPECT_EQ(lagged_.counts().factorisations, 1);
  EXPECT_GE(lagged_.counts().iterations, 3);
  EXPECT_LE(lagged_.counts().iterations, 10);
  RecordProperty("iterations_drift_1_percent", static_cast<int>(lagged_.counts().iterations));
}

TEST_F(LaggedPreconditionerTest, AGoodGuessSavesIterations) {
  solve(flow_matrix(n, 0.2));
  const auto drifted = flow_matrix(n, 0.21);
  const Eigen::VectorXd x = solve(drifted);
  const long before = lagged_.counts().iterations;
  lagged_.solve({drifted, load(size), x, Eigen::VectorXd::Constant(size, 1e-12)});
  EXPECT_EQ(lagged_.counts().iterations, before);
}

TEST_F(LaggedPreconditionerTest, MatrixThatChangedALotIsFactoredAnew) {
  solve(flow_matrix(n, 0.0));
  const auto changed = flow_matrix(n, 0.95);
  EXPECT_LE(difference_from_dense(changed, solve(changed)), 1e-12);
  EXPECT_EQ(lagged_.counts().factorisations, 2);
  EXPECT_LE(lagged_.counts().iterations, IterationLimits().max_iterations);
  solve(changed);
  EXPECT_EQ(lagged_.counts().factorisations, 2);
}

TEST_F(LaggedPreconditionerTest, AfterATiringSolutionTheNextMatrixIsFactored) {
  solve(flow_matrix(n, 0.0));
  solve(flow_matrix(n, 0.2));
  EXPECT_EQ(lagged_.counts().factorisations, 1);
  EXPECT_GT(lagged_.counts().iterations, LagLimits().tiring_iterations);
  const long before = lagged_.counts().iterations;
  const auto next = flow_matrix(n, 0.21);
  EXPECT_LE(difference_from_dense(next, solve(next)), 1e-12);
  EXPECT_EQ(lagged_.counts().factorisations, 2);
  EXPECT_EQ(lagged_.counts().iterations, before);
}

TEST_F(LaggedPreconditionerTest, HopelessIterationsEndEarly) {
  solve(flow_matrix(n, 0.0));
  // Stronger grounding, up to a thousand times, varies from place to place: it adds many
  // eigenvalues.
  Eigen::SparseMatrix<double> changed = flow_matrix(n, 0.0);
  for (int i = 0; i < static_cast<int>(size); ++i)
    changed.coeffRef(i, i) += std::pow(10.0, 3.0 * std::sin(7.0 * i));
  EXPECT_LE(difference_from_dense(changed, solve(changed)), 1e-12);
  EXPECT_EQ(lagged_.counts().factorisations, 2);
  EXPECT_EQ(lagged_.counts().iterations, IterationLimits().pace_iterations);
}

TEST_F(LaggedPreconditionerTest, RefusesWhatIsNotPositiveDefiniteOrNotFinite) {
  Eigen::SparseMatrix<double> matrix = flow_matrix(n, 0.0);
  matrix.coeffRef(3, 3) = -1.0;
  EXPECT_THROW(solve(matrix), NumericalError);
  matrix.coeffRef(3, 3) = std::nan("");
  EXPECT_THROW(solve(matrix), NumericalError);
  EXPECT_NO_THROW(solve(flow_matrix(n, 0.0)));
}

TEST_F(LaggedPreconditionerTest, MatrixThatComesAgainAndAgainIsFactored) {
  solve(flow_matrix(n, 0.0));
  const auto changed = flow_matrix(n, 0.05);
  for (int i = 0; i < 5; ++i) EXPECT_LE(difference_from_dense(changed, solve(changed)), 1e-12);
  EXPECT_EQ(lagged_.counts().factorisations, 2);
  EXPECT_GE(lagged_.counts().iterations, LagLimits().repeated_iterations);
  EXPECT_LT(lagged_.counts().iterations,
            LagLimits().repeated_iterations + LagLimits().tiring_iterations);
}

/// Eigen's factor with Eigen's substitution: the equivalent of CholeskyFactor, with the same
/// interface.
class EigenFactor final : public Factor {
 public:
  void factorise(const Eigen::SparseMatrix<double>& matrix) override { factor_.compute(matrix); }
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) override { x = factor_.solve(rhs); }

 private:
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

TEST(CholeskyFactor, SolvesAsEigenDoes) {
  for (const int side : {1, 7, 110}) {
    CholeskyFactor factor;
    EigenFactor twin;
    const Eigen::SparseMatrix<double> matrix = flow_matrix(side, 0.5);
    factor.factorise(matrix);
    twin.factorise(matrix);
    Eigen::VectorXd solution;
    Eigen::VectorXd expected;
    factor.solve(load(matrix.rows()), solution);
    twin.solve(load(matrix.rows()), expected);
    EXPECT_LE((solution - expected).lpNorm<Eigen::Infinity>(),
              1e-13 * expected.lpNorm<Eigen::Infinity>())
        << side;
  }
}

TEST(CholeskyFactor, TheSameMatrixGivesTheSameBitsWhateverWasFactoredBefore) {
  const Eigen::SparseMatrix<double> matrix = flow_matrix(30, 0.5);
  const Eigen::VectorXd rhs = load(matrix.rows());
  CholeskyFactor fresh;
  fresh.factorise(matrix);
  CholeskyFactor used;
  used.factorise(flow_matrix(30, 0.9));
  used.factorise(matrix);
  Eigen::VectorXd expected;
  Eigen::VectorXd solution;
  fresh.solve(rhs, expected);
  used.solve(rhs, solution);
  EXPECT_EQ(solution, expected);
}

TEST(CholeskyFactor, WorksAgainAfterAMatrixThatItRefused) {
  Eigen::SparseMatrix<double> matrix = flow_matrix(7, 0.0);
  CholeskyFactor factor;
  matrix.coeffRef(3, 3) = -1.0;
  EXPECT_THROW(factor.factorise(matrix), NumericalError);
  matrix = flow_matrix(7, 0.0);
  factor.factorise(matrix);
  Eigen::VectorXd solution;
  factor.solve(load(matrix.rows()), solution);
  EXPECT_LE(difference_from_dense(matrix, solution), 1e-12);
}

TEST(LaggedPreconditioner, TakesAnyFactor) {
  LaggedPreconditioner own;
  LaggedPreconditioner other(1, {}, std::make_unique<EigenFactor>());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(225);
  const Eigen::VectorXd tolerance = Eigen::VectorXd::Constant(225, 1e-14);
  for (const double amount : {0.2, 0.21, 0.95}) {
    const Eigen::SparseMatrix<double> matrix = flow_matrix(15, amount);
    for (LaggedPreconditioner* solver : {&own, &other}) {
      EXPECT_LE(difference_from_dense(matrix, solver->solve({matrix, load(225), zero, tolerance})),
                1e-12);
    }
    EXPECT_EQ(own.counts().factorisations, other.counts().factorisations) << amount;
    EXPECT_EQ(own.counts().iterations, other.counts().iterations) << amount;
  }
}

TEST(LaggedPreconditioner, TwoThreadsGiveTheSameBits) {
  constexpr int side = 110;  // large enough for shared loops
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(side * side);
  const Eigen::VectorXd tolerance = Eigen::VectorXd::Constant(side * side, 1e-12);
  const auto solution = [&](int threads) {
    LaggedPreconditioner solver(threads);
    solver.solve({flow_matrix(side, 0.2), load(side * side), zero, tolerance});
    const Eigen::VectorXd x =
        solver.solve({flow_matrix(side, 0.21), load(side * side), zero, tolerance});
    EXPECT_GT(solver.counts().iterations, 0);
    return x;
  };
  EXPECT_EQ(solution(1), solution(2));
}

/// Multigrid that does not converge, as for strongly layered soil whose bedding is oblique.
class UselessFactor final : public Factor {
 public:
  void factorise(const Eigen::SparseMatrix<double>&) override {}
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) override { x = rhs; }
  [[nodiscard]] bool is_exact() const override { return false; }
};

TEST(LaggedPreconditioner, FactorsAMatrixThatIterationsDoNotSolve) {
  // Of a chain of n conductances conjugate gradients alone take n iterations.
  constexpr int n = 3000;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 2.0);
    if (i > 0) entries.emplace_back(i, i - 1, -1.0);
    if (i + 1 < n) entries.emplace_back(i, i + 1, -1.0);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(n);
  rhs[n - 1] = 1.0;
  LaggedPreconditioner lagged(1, {}, std::make_unique<UselessFactor>());
  const Eigen::VectorXd x =
      lagged.solve({matrix, rhs, Eigen::VectorXd::Zero(n), Eigen::VectorXd::Constant(n, 1e-14)});
  for (int i = 0; i < n; ++i) EXPECT_NEAR(x[i], (i + 1.0) / (n + 1.0), 1e-9);
}

}  // namespace lagged_preconditioner_test
}  // namespace suffuse

#include "linear/multigrid.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <memory>

#include "common/errors.hpp"
#include "linear/lagged_preconditioner.hpp"
#include "linear/newton_system.hpp"

namespace suffuse {
namespace multigrid_test {

/// Seven-point matrix of flow through n x n x n cells, grounded at one side. `contrast` is that of
/// the conductivities of layers, which are multiplied by up to 1e4 at random places.
Eigen::SparseMatrix<double> flow_matrix(int n, double contrast) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto conductivity = [&](int i, int j, int k) {
    if (contrast == 1.0) return 1.0;
    const double layer = (k / 4) % 2 == 0 ? 1.0 : contrast;
    return layer * std::pow(10.0, 4.0 * std::abs(std::sin(12.9 * i + 78.2 * j + 37.7 * k)));
  };
  const auto at = [&](int i, int j, int k) { return (k * n + j) * n + i; };
  const auto connect = [&](int a, int b, double one, double other) {
    const double conductance = 2.0 * one * other / (one + other);
    entries.emplace_back(a, a, conductance);
    entries.emplace_back(b, b, conductance);
    entries.emplace_back(a, b, -conductance);
    entries.emplace_back(b, a, -conductance);
  };
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const double here = conductivity(i, j, k);
        const int a = at(i, j, k);
        if (i + 1 < n) connect(a, at(i + 1, j, k), here, conductivity(i + 1, j, k));
        if (j + 1 < n) connect(a, at(i, j + 1, k), here, conductivity(i, j + 1, k));
        if (k + 1 < n) connect(a, at(i, j, k + 1), here, conductivity(i, j, k + 1));
        if (i == 0) entries.emplace_back(a, a, 2.0 * here);
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(n * n * n, n * n * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::VectorXd waves(Eigen::Index count) {
  Eigen::VectorXd x(count);
  for (Eigen::Index i = 0; i < count; ++i) x[i] = 1.0 + std::cos(0.37 * static_cast<double>(i));
  return x;
}

struct Solved {
  Eigen::VectorXd x;
  long iterations = 0;
};

Solved solve(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& rhs,
             int threads = 1) {
  LaggedPreconditioner solver(threads, {}, std::make_unique<Multigrid>());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(rhs.size());
  Solved solved{solver.solve({matrix, rhs, zero, zero}), 0};
  solved.iterations = solver.counts().iterations;
  return solved;
}

TEST(Multigrid, FindsTheSolutionThatTheRightHandSideWasMadeOf) {
  for (const double contrast : {1.0, 1e8}) {
    const auto matrix = flow_matrix(20, contrast);
    const Eigen::VectorXd exact = waves(matrix.rows());
    const Solved solved = solve(matrix, matrix * exact);
    // With a total contrast of 1e12, the round-off of the right-hand side causes errors of 1e-4.
    const double error = (solved.x - exact).lpNorm<Eigen::Infinity>();
    EXPECT_LE(error, contrast == 1.0 ? 1e-11 : 1e-3);
    const Eigen::VectorXd left = matrix * (solved.x - exact);
    const Eigen::VectorXd size = matrix.diagonal();
    EXPECT_LE((left.array() / size.array()).abs().maxCoeff(), 1e-14);
  }
}

TEST(Multigrid, IterationsHardlyGrowWithSizeAndContrast) {
  std::array<std::array<long, 2>, 2> iterations{};
  for (const int level : {0, 1}) {
    for (const int hard : {0, 1}) {
      const auto matrix = flow_matrix(20 << level, hard == 0 ? 1.0 : 1e8);
      iterations.at(level).at(hard) = solve(matrix, matrix * waves(matrix.rows())).iterations;
      std::cout << (20 << level) << "^3, contrast " << hard << ": " << iterations.at(level).at(hard)
                << " iterations\n";
    }
  }
  for (const int hard : {0, 1}) {
    EXPECT_LE(iterations[1].at(hard), 1.5 * static_cast<double>(iterations[0].at(hard)));
    EXPECT_LE(iterations[1].at(hard), 80);
  }
}

TEST(Multigrid, GivesTheSameBitsOnAnyNumberOfThreads) {
  const auto matrix = flow_matrix(30, 1e8);
  const Eigen::VectorXd rhs = waves(matrix.rows());
  EXPECT_EQ(solve(matrix, rhs, 1).x, solve(matrix, rhs, 2).x);
}

TEST(Multigrid, RefusesWhatIsNotPositiveDefinite) {
  auto matrix = flow_matrix(15, 1.0);
  matrix.coeffRef(5, 5) = -1.0;
  Multigrid multigrid;
  EXPECT_THROW(multigrid.factorise(matrix), NumericalError);
}

TEST(Multigrid, IsTakenForLargeModelsOfThreeDimensions) {
  EXPECT_FALSE(flow_factor(3, 30'000)->is_exact());
  EXPECT_TRUE(flow_factor(3, 29'999)->is_exact());
  EXPECT_TRUE(flow_factor(2, 10'000'000)->is_exact());
  EXPECT_FALSE(newton_factor(3, 3'000)->is_exact());
  EXPECT_TRUE(newton_factor(3, 2'999)->is_exact());
  EXPECT_TRUE(newton_factor(2, 10'000'000)->is_exact());
}

/// Like the tangent at a front of water in dry soil: the coupling from a wet layer to the one below
/// is one-sided, and 300 times the symmetric coupling.
TEST(NewtonSystem, SolvesTangentsThatAreFarFromTheSymmetricMatrix) {
  constexpr int n = 24;
  Eigen::SparseMatrix<double> nearly = flow_matrix(n, 1.0);
  Eigen::SparseMatrix<double> tangent = nearly;
  for (int a = 0; a + n * n < n * n * n; ++a) {
    if ((a / (n * n)) % 6 > 2) continue;
    nearly.coeffRef(a, a) += 300.0;
    tangent.coeffRef(a, a) += 300.0;
    tangent.coeffRef(a + n * n, a) -= 300.0;
  }
  const Eigen::VectorXd rhs = waves(nearly.rows());
  NewtonSystem system(newton_factor(3, n * n * n));
  Eigen::VectorXd x;
  system.solve_tangent(nearly, tangent, rhs, x);
  EXPECT_LE((rhs - tangent * x).norm(), 1.001e-4 * rhs.norm());
  EXPECT_LE(system.counts().iterations, 16);
  const long before = system.counts().iterations;
  try {
    system.solve(tangent, rhs, x, 1e-4);
  } catch (const NumericalError&) {
    std::cout << "not solved with the symmetric matrix alone\n";
  }
  std::cout << before << " iterations with both stages, " << system.counts().iterations - before
            << " with one\n";
  EXPECT_GT(2 * (system.counts().iterations - before), 3 * before);
}

}  // namespace multigrid_test
}  // namespace suffuse

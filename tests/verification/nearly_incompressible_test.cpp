/// Elastic soil that hardly changes its volume: displacements against an exact solution.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "solver/solid_model.hpp"
#include "verification/free_mesh.hpp"

namespace suffuse {
namespace nearly_incompressible_test {

using model::PlaneModel;

constexpr double pi = std::numbers::pi;
constexpr double young = 1e6;
/// So small that strains are those of linear elasticity to six digits.
constexpr double size_of_motion = 1e-7;

/// The curl of sin^2(pi x) sin^2(pi y): no change of volume, and none at the sides of the square.
Vector<2> exact_displacement(const Vector<2>& x) {
  const auto swirl = [](double s, double t) {
    return pi * std::pow(std::sin(pi * s), 2) * std::sin(2.0 * pi * t);
  };
  return size_of_motion * Vector<2>(swirl(x[0], x[1]), -swirl(x[1], x[0]));
}

/// The force that holds it, -G times the Laplacian of the displacement, N/m3.
Vector<2> exact_force(const Vector<2>& x, double shear_modulus) {
  const auto laplacian = [](double s, double t) {
    return 2.0 * std::pow(pi, 3) * std::sin(2.0 * pi * t) * (2.0 * std::cos(2.0 * pi * s) - 1.0);
  };
  return -shear_modulus * size_of_motion * Vector<2>(laplacian(x[0], x[1]), -laplacian(x[1], x[0]));
}

/// Error of the displacements of the nodes, in the mean of squares, relative to the exact ones.
double error_of(Mesh<2> mesh, double poisson) {
  PlaneModel m(std::move(mesh), 1, model::elastic_soil(young, poisson));
  for (const char* side : {"left", "right", "bottom", "top"}) m.support(side, Support::both);
  NodeVectors<2> loads = m.no_loads();
  const double shear_modulus = young / (2.0 * (1.0 + poisson));
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    for (const QuadraturePoint<2>& at : gauss_rule<2>(6)) {
      const Vector<2> place = PointPlace<2>{e, at.barycentric}.position(m.mesh);
      const Vector<2> force = at.weight * m.grid.volume[e] * exact_force(place, shear_modulus);
      for (int a = 0; a <= 2; ++a) loads[m.mesh.elements[e][a]] += at.barycentric[a] * force;
    }
  }
  const NewtonSolution<2> solution = m.step(loads);
  EXPECT_TRUE(solution.converged);
  double off = 0.0;
  double all = 0.0;
  for (int i = 0; i < m.mesh.node_count(); ++i) {
    const Vector<2> exact = exact_displacement(m.mesh.nodes[i]);
    off += (solution.displacement[i] - exact).squaredNorm();
    all += exact.squaredNorm();
  }
  return std::sqrt(off / all);
}

Mesh<2> crossed(int cells) {
  return model::crossed_mesh(cells, cells, 1.0, 1.0);
}
Mesh<2> in_rows(int cells) {
  return model::column_mesh(cells, cells, 1.0, 1.0);
}
Mesh<2> free(int cells) {
  return model::free_mesh(1.0 / cells);
}

/// The errors for a Poisson's ratio of 0.4999 are of the same order as those for 0.3: the elements
/// do not lock.
class NearlyIncompressibleSoil : public ::testing::TestWithParam<Mesh<2> (*)(int)> {};
INSTANTIATE_TEST_SUITE_P(Triangles, NearlyIncompressibleSoil,
                         ::testing::Values(crossed, in_rows, free));

TEST_P(NearlyIncompressibleSoil, DoesNotLock) {
  for (const double poisson : {0.3, 0.4999}) {
    std::vector<double> error;
    for (const int cells : {8, 16, 32}) error.push_back(error_of(GetParam()(cells), poisson));
    const double order = std::log2(error[1] / error[2]);
    std::cout << "nu " << poisson << ": " << error[0] << ", " << error[1] << ", " << error[2]
              << ", order " << order << '\n';
    EXPECT_LT(error[2], poisson > 0.4 ? 0.003 : 0.01);
    EXPECT_GT(order, 1.9);
  }
}

}  // namespace nearly_incompressible_test
}  // namespace suffuse

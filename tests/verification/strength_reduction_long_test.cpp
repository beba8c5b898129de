/// Factors of safety of soil with less dilation than friction, on meshes on which Newton's method
/// alone does not converge.

#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "solver/solid_model.hpp"
#include "tools/strength_reduction.hpp"

namespace suffuse {
namespace strength_reduction_long_test {

/// Half of a strip of width 2 m on weightless soil without dilation, under 15 times its cohesion.
SafetyFactor strip_factor(int cells) {
  SkeletonModel soil;
  soil.law = skeleton_law("mohr-coulomb");
  soil.young = 1e8;
  soil.poisson = 0.3;
  soil.friction = 30.0;
  soil.cohesion = 1e3;
  model::PlaneModel m(model::crossed_mesh(10 * cells, 6 * cells, 10.0, 6.0), 1, soil);
  m.support("bottom", Support::both);
  m.support("left", Support::normal);
  m.support("right", Support::normal);
  std::vector<int> strip;
  for (const int f : m.faces_of("top")) {
    if (m.grid.face_centre(f)[0] < 1.0) strip.push_back(f);
  }
  NodalLoads<2> loads(m.grid);
  LoadedSurface<2>(m.grid, m.sorted, strip)
      .add_traction(m.grid, m.sorted, Vector<2>(0.0, -15e3), loads);
  const Supports<2> supports(m.grid, m.face_support);
  const SafetyFactor found = find_safety_factor<2>(m.body(), supports, loads, {}, 1);
  for (const StrengthTrial& trial : found.trials) {
    std::cout << "  " << trial.factor << ": end " << static_cast<int>(trial.end) << ", residual "
              << trial.residual << ", iterations " << trial.iterations << "\n";
  }
  std::cout << m.mesh.element_count() << " elements: factor " << found.factor << std::endl;
  return found;
}

TEST(Strip, OnSoilWithoutDilationHasAFactorThatTheMeshHardlyChanges) {
  const SafetyFactor coarse = strip_factor(2);
  const SafetyFactor fine = strip_factor(4);
  EXPECT_EQ(coarse.undecided_node, -1);
  EXPECT_EQ(fine.undecided_node, -1);
  EXPECT_NEAR(fine.factor, coarse.factor, 0.06 * coarse.factor);
}

}  // namespace strength_reduction_long_test
}  // namespace suffuse

/// Strength reduction with quadratic displacements, against exact and published limit loads, and
/// against itself: buoyant soil, space and plane, threads.

#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "box_mesh.hpp"
#include "equilibrium/quadratic_equilibrium.hpp"
#include "tools/strength_reduction.hpp"
#include "verification/footing.hpp"

namespace suffuse {
namespace quadratic_displacements_test {

constexpr double unit_weight = 2e4;  ///< N/m3

SkeletonModel soil_of(double friction, double cohesion, double dilation) {
  SkeletonModel soil;
  soil.law = skeleton_law("mohr-coulomb");
  soil.young = 1e8;
  soil.poisson = 0.3;
  soil.friction = friction;
  soil.cohesion = cohesion;
  soil.dilation = dilation;
  return soil;
}

template <int Dim>
SafetyFactor factor_of(const model::SolidModel<Dim>& m, const NodalLoads<Dim>& loads,
                       double tolerance, const std::vector<double>& pressure = {},
                       int threads = 1) {
  StrengthReductionLimits limits;
  limits.tolerance = tolerance;
  const Supports<Dim> supports(m.grid, m.face_support);
  const SafetyFactor found =
      find_safety_factor<Dim>(m.body(), supports, loads, pressure, threads, limits);
  std::cout << m.mesh.element_count() << " elements, " << (loads.shapes() ? "quadratic" : "linear")
            << ": factor " << found.factor << std::endl;
  return found;
}

// ------------------------------------------------------------------------------ strips and slopes

/// Half of a strip of width 2 on free triangles with `cells` below it, under a uniform load that is
/// the exact limit. A factor above 1 is the ratio of the limit load found to that.
double strip_factor(int cells, double friction, double width, double height) {
  model::PlaneModel m(model::free_mesh(1.0 / cells, width, height), 3,
                      soil_of(friction, 1e3, friction));
  m.support("bottom", Support::both);
  m.support("left", Support::normal);
  m.support("right", Support::normal);
  std::vector<int> strip;
  for (const int f : m.faces_of("top")) {
    if (m.grid.face_centre(f)[0] < 1.0) strip.push_back(f);
  }
  NodalLoads<2> loads = m.no_quadratic_loads();
  LoadedSurface<2>(m.grid, m.sorted, strip)
      .add_traction(m.grid, m.sorted,
                    Vector<2>(0.0, -1e3 * footing::exact_cohesion_factor(friction)), loads);
  return factor_of(m, loads, 2e-3).factor;
}

TEST(QuadraticStrip, OnFreeTrianglesCarriesPrandtlsLoad) {
  const double coarse = strip_factor(2, 0.0, 4.0, 2.25);
  const double fine = strip_factor(4, 0.0, 4.0, 2.25);
  EXPECT_LT(fine, coarse);
  EXPECT_NEAR(coarse, 1.0, 0.03);
  EXPECT_NEAR(fine, 1.0, 0.015);
  EXPECT_GT(fine, 1.0) << "an upper bound";
}

TEST(QuadraticStrip, OnSoilWithFrictionCarriesThatToo) {
  EXPECT_NEAR(strip_factor(2, 20.0, 8.0, 4.5), 1.0, 0.02);
}

/// A slope of 2:1, of height 1 m on a rigid base, from a mesh of the unit square or cube.
template <int Dim>
Mesh<Dim> slope_mesh(Mesh<Dim> mesh) {
  for (Vector<Dim>& x : mesh.nodes) x[0] *= 1.2 + 2.0 * (1.0 - x[Dim - 1]);
  return mesh;
}
struct Slope : model::PlaneModel {
  explicit Slope(const Mesh<2>& square, double weight = unit_weight)
      : PlaneModel(slope_mesh(square), 3, soil_of(20.0, 0.05 * weight, 20.0)) {
    support("bottom", Support::both);
    support("left", Support::normal);
  }
};

/// Errors are proportional to the size of elements. Linear displacements have 1.66 and 1.52 on the
/// first two meshes.
TEST(QuadraticSlope, HasAFactorThatConvergesFromCoarseMeshes) {
  const auto factor = [](const Mesh<2>& square) {
    const Slope m(square);
    return factor_of(m, m.quadratic_weight(unit_weight), 2e-3).factor;
  };
  const double coarse = factor(model::crossed_mesh(9, 3, 1.0, 1.0));
  const double fine = factor(model::crossed_mesh(15, 5, 1.0, 1.0));
  const double finest = factor(model::crossed_mesh(24, 8, 1.0, 1.0));
  const double first_limit = fine - 3.0 / 2.0 * (coarse - fine);
  const double limit = finest - 5.0 / 3.0 * (fine - finest);
  std::cout << "limits " << first_limit << ", " << limit << std::endl;
  EXPECT_GT(coarse, fine);
  EXPECT_GT(fine, finest);
  EXPECT_NEAR(first_limit, limit, 0.01 * limit);
  EXPECT_NEAR(limit, 1.4, 0.03 * 1.4) << "Griffiths and Lane";
  EXPECT_NEAR(coarse, limit, 0.05 * limit);
  EXPECT_NEAR(factor(model::free_mesh(0.2)), limit, 0.06 * limit);
}

/// Soil under still water has the factor of dry soil with its buoyant weight.
TEST(QuadraticSlope, UnderWaterHasTheFactorOfItsBuoyantWeight) {
  constexpr double water = 9.81e3;  // N/m3
  constexpr double level = 1.5;     // m
  Slope m(model::free_mesh(0.2), unit_weight - water);
  const SafetyFactor buoyant = factor_of(m, m.quadratic_weight(unit_weight - water), 1e-3);
  std::vector<double> pressure;
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    pressure.push_back(water * (level - element_centroid(m.mesh, e)[1]));
  }
  NodalLoads<2> loads = m.quadratic_weight(unit_weight);
  for (const char* side : {"top", "right"}) {
    LoadedSurface<2>(m.grid, m.sorted, m.faces_of(side))
        .add_pressures(
            m.grid, m.sorted, [&](const Vector<2>& x) { return water * (level - x[1]); }, loads);
  }
  const SafetyFactor found = factor_of(m, loads, 1e-3, pressure);
  EXPECT_NEAR(found.factor, buoyant.factor, 2e-3 * buoyant.factor);
  // Displacements close to the limit depend on the last digits of the loads: compare those at 1.
  ASSERT_EQ(found.trials[0].end, Settling::rests);
  EXPECT_NEAR(found.trials[0].displacement_max, buoyant.trials[0].displacement_max,
              0.01 * buoyant.trials[0].displacement_max);
}

TEST(QuadraticSlope, ExtrudedInSpaceHasTheFactorOfItsSection) {
  constexpr int cells = 3;
  const Slope plane(model::column_mesh(3 * cells, cells, 1.0, 1.0));
  const double of_section = factor_of(plane, plane.quadratic_weight(unit_weight), 5e-3).factor;
  model::SolidModel<3> space(
      slope_mesh(model::box_mesh({3 * cells, 1, cells}, {1.0, 1.0 / cells, 1.0})),
      model::places_in_tetrahedron(), soil_of(20.0, 0.05 * unit_weight, 20.0));
  space.support("bottom", Support::both);
  for (const char* side : {"left", "front", "back"}) space.support(side, Support::normal);
  const double found = factor_of(space, space.quadratic_weight(unit_weight), 5e-3).factor;
  EXPECT_NEAR(found, of_section, 0.01 * of_section);
}

TEST(QuadraticSlope, HasTheSameFactorToTheLastBitOnTwoThreads) {
  const Slope m(model::crossed_mesh(9, 3, 1.0, 1.0));
  const SafetyFactor one = factor_of(m, m.quadratic_weight(unit_weight), 0.01, {}, 1);
  const SafetyFactor two = factor_of(m, m.quadratic_weight(unit_weight), 0.01, {}, 2);
  ASSERT_EQ(one.trials.size(), two.trials.size());
  for (std::size_t k = 0; k < one.trials.size(); ++k) {
    EXPECT_EQ(one.trials[k].displacement_max, two.trials[k].displacement_max);
  }
  EXPECT_EQ(one.mechanism, two.mechanism);
}

/// A slope of 2:1 cut out of the points of a box, with a lump of soil on its crest or without: its
/// surface lies inside elements.
double factor_in_box(bool lump) {
  constexpr double size = 0.25;
  model::PlaneModel m(model::crossed_mesh(14, 5, 3.5, 1.25), 3,
                      soil_of(20.0, 0.05 * unit_weight, 20.0), [=](const Vector<2>& x) {
                        const Vector<2> from_lump =
                            x - Vector<2>(0.5 + size / 6.0, 1.0 + size / 2.0);
                        return (x[1] < 1.0 && x[0] < 1.2 + 2.0 * (1.0 - x[1])) ||
                               (lump && from_lump.norm() < 0.25 * size);
                      });
  m.support("bottom", Support::both);
  m.support("left", Support::normal);
  return factor_of(m, m.quadratic_weight(unit_weight), 0.01).factor;
}

TEST(QuadraticSlope, WithALooseLumpOnItsCrestHasTheSameFactor) {
  const double clean = factor_in_box(false);
  EXPECT_NEAR(clean, 1.4, 0.05);
  EXPECT_NEAR(factor_in_box(true), clean, 0.01 * clean);
}

// ----------------------------------------------------------------------------------------- tangent

/// Matrix times a small step against the difference of the forces, with supports along slopes.
TEST(QuadraticEquilibrium, HasTheTangentOfItsForces) {
  Slope m(model::free_mesh(0.3));
  m.support("right", Support::normal);
  const Supports<2> supports(m.grid, m.face_support);
  const NodalLoads<2> loads = m.quadratic_weight(unit_weight);
  QuadraticEquilibrium<2> equilibrium(m.body(), supports, *loads.shapes(), 1);
  equilibrium.set_pressure(std::vector<double>(m.mesh.element_count(), 1e3));
  const auto count = equilibrium.unknowns().count();
  const Eigen::VectorXd at = 1e-5 * Eigen::VectorXd::LinSpaced(count, -1.0, 2.0).array().sin();
  const Eigen::VectorXd step = 1e-10 * Eigen::VectorXd::LinSpaced(count, 0.0, 9.0).array().cos();
  const auto forces_at = [&](const Eigen::VectorXd& components, bool with_tangents) {
    NodeVectors<2> displacement(loads.forces().size(), Vector<2>::Zero());
    equilibrium.unknowns().add(components, 1.0, displacement);
    equilibrium.displace(displacement, with_tangents);
    return equilibrium.unknowns().components(equilibrium.forces());
  };
  const Eigen::VectorXd change = forces_at(at + step, false) - forces_at(at - step, false);
  forces_at(at, true);
  Eigen::SparseMatrix<double> tangent;
  equilibrium.assemble(tangent);
  EXPECT_LT((tangent * (2.0 * step) - change).norm(), 1e-4 * change.norm());
  Eigen::SparseMatrix<double> elastic;
  equilibrium.assemble_elastic(elastic);
  EXPECT_LT((Eigen::SparseMatrix<double>(elastic.transpose()) - elastic).norm(),
            1e-12 * elastic.norm());
}

}  // namespace quadratic_displacements_test
}  // namespace suffuse

/// Factors of safety of slopes by reduction of strength, against exact and published values.

#include "tools/strength_reduction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>

#include "equilibrium/pseudo_time.hpp"
#include "solver/solid_model.hpp"

namespace suffuse {
namespace strength_reduction_test {

using model::PlaneModel;

constexpr double degree = std::numbers::pi / 180.0;

/// Soil with angles in degrees.
SkeletonModel mohr_coulomb_soil(double friction, double cohesion, double dilation,
                                double young = 1e8) {
  SkeletonModel soil;
  soil.law = skeleton_law("mohr-coulomb");
  soil.young = young;
  soil.poisson = 0.3;
  soil.friction = friction;
  soil.cohesion = cohesion;
  soil.dilation = dilation;
  return soil;
}

SafetyFactor safety_factor(const PlaneModel& m, const NodalLoads<2>& loads, double tolerance,
                           const std::vector<double>& pressure = {}) {
  StrengthReductionLimits limits;
  limits.tolerance = tolerance;
  const Supports<2> supports(m.grid, m.face_support);
  SafetyFactor result =
      find_safety_factor<2>(m.body(), supports, loads, pressure, m.threads, limits);
  for (const StrengthTrial& trial : result.trials) {
    std::cout << "  " << trial.factor
              << (trial.end == Settling::rests       ? " holds"
                  : trial.end == Settling::runs_away ? " fails"
                                                     : " decides nothing")
              << ", residual " << trial.residual << ", displacement " << trial.displacement_max
              << " m, iterations " << trial.iterations << "\n";
  }
  std::cout << m.mesh.element_count() << " elements: factor " << result.factor << std::endl;
  return result;
}

TEST(ReducedStrength, DividesCohesionAndTheTangentOfFriction) {
  const SkeletonParameters full{1e7, 0.3, 30.0 * degree, 1e4, 20.0 * degree};
  const SkeletonParameters half = reduced_strength(full, 2.0);
  EXPECT_DOUBLE_EQ(half.cohesion, 5e3);
  EXPECT_DOUBLE_EQ(std::tan(half.friction), 0.5 * std::tan(full.friction));
  EXPECT_EQ(half.dilation, half.friction);  // 16.1 degrees, less than 20
  EXPECT_EQ(reduced_strength(full, 1.2).dilation, full.dilation);
  EXPECT_EQ(half.young, full.young);
}

// ---------------------------------------------------------------------------- the infinite slope

/// A piece of an infinite slope, rotated so that its surface is the top of a box. Its sides carry
/// the stress of the infinite slope, with the normal stress at the limit: the stress is then known
/// everywhere, and no other failure precedes that along the slope.
struct InfiniteSlope {
  double slope = 0.0;         ///< beta, rad
  double weight = 0.0;        ///< of the soil with its water, N/m3
  double water_weight = 0.0;  ///< N/m3; 0: dry

  [[nodiscard]] double mobilised() const {
    return std::tan(slope) * weight / (weight - water_weight);
  }
  /// Pressure of water that flows along the slope, Pa.
  [[nodiscard]] double pressure(double depth) const {
    return water_weight * std::cos(slope) * depth;
  }
  /// Total traction on a plane across the slope that faces down the slope, Pa.
  [[nodiscard]] Vector<2> traction(double depth) const {
    const double across = -(weight - water_weight) * std::cos(slope) * depth;  // effective
    const double along = across * (1.0 + 2.0 * mobilised() * mobilised());
    return {along - pressure(depth), weight * std::sin(slope) * depth};
  }

  /// Adds the loads of a piece of this height.
  void load(const PlaneModel& m, double height, NodalLoads<2>& loads) const {
    std::vector<Vector<2>> force;
    for (const double v : m.points.reference_volume) {
      force.emplace_back(weight * v * Vector<2>(std::sin(slope), -std::cos(slope)));
    }
    add_point_forces(m.grid, m.points, force, loads);
    for (const char* side : {"left", "right"}) {
      for (const int f : m.faces_of(side)) {
        const double sign = m.grid.face_centre(f)[0] > 1e-9 ? 1.0 : -1.0;
        const auto& [a, b] = m.grid.face_nodes[f];
        const Vector<2> at_a = traction(height - m.mesh.nodes[a][1]);
        const Vector<2> at_b = traction(height - m.mesh.nodes[b][1]);
        const double area = sign * m.grid.face_normal[f].norm() / 6.0;
        loads.forces()[a] += area * (2.0 * at_a + at_b);
        loads.forces()[b] += area * (at_a + 2.0 * at_b);
        if (!loads.shapes()) continue;
        loads.forces()[loads.shapes()->edge_between(a, b)] += 2.0 * area * (at_a + at_b);
      }
    }
  }
};

/// Relative error of the factor of safety.
double infinite_slope_error(const InfiniteSlope& slope, double friction, double dilation,
                            bool is_quadratic = false) {
  const double height = 3.0;
  PlaneModel m(model::crossed_mesh(4, 6, 2.0, height), 1,
               mohr_coulomb_soil(friction, 0.0, dilation));
  m.support("bottom", Support::both);
  std::vector<double> pressure(m.mesh.element_count());
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    pressure[e] = slope.pressure(height - element_centroid(m.mesh, e)[1]);
  }
  const double exact = std::tan(friction * degree) / slope.mobilised();
  NodalLoads<2> loads = is_quadratic ? m.no_quadratic_loads() : NodalLoads<2>(m.grid);
  slope.load(m, height, loads);
  const SafetyFactor found = safety_factor(m, loads, 2e-3, pressure);
  std::cout << "infinite slope: " << found.factor << ", exact " << exact << std::endl;
  return found.factor / exact - 1.0;
}

TEST(InfiniteSlope, FailsWhereFrictionDoes) {
  const InfiniteSlope dry{.slope = 20.0 * degree, .weight = 1.8e4};
  EXPECT_NEAR(infinite_slope_error(dry, 32.0, 32.0), 0.0, 5e-3);
}

TEST(InfiniteSlope, FailsUnderSeepageAlongItAtHalfTheFactor) {
  const InfiniteSlope wet{.slope = 15.0 * degree, .weight = 2e4, .water_weight = 9.81e3};
  EXPECT_NEAR(infinite_slope_error(wet, 35.0, 35.0), 0.0, 5e-3);
  EXPECT_NEAR(infinite_slope_error(wet, 25.0, 25.0), 0.0, 5e-3);  // below 1
}

TEST(InfiniteSlope, FailsThereOnQuadraticDisplacementsToo) {
  const InfiniteSlope dry{.slope = 20.0 * degree, .weight = 1.8e4};
  EXPECT_NEAR(infinite_slope_error(dry, 32.0, 32.0, true), 0.0, 1e-3);
  const InfiniteSlope wet{.slope = 15.0 * degree, .weight = 2e4, .water_weight = 9.81e3};
  EXPECT_NEAR(infinite_slope_error(wet, 35.0, 35.0, true), 0.0, 1e-3);
}

// ---------------------------------------------------------------------- slopes and cuts of a
// height

/// A slope of 2:1, of height 1 m on a rigid base, with `cells` over the height.
struct SlopeTwoToOne : PlaneModel {
  SlopeTwoToOne(int cells, const SkeletonModel& soil) : PlaneModel(mesh_of(cells), 1, soil) {
    support("bottom", Support::both);
    support("left", Support::normal);
  }
  static Mesh<2> mesh_of(int cells) {
    Mesh<2> mesh = model::crossed_mesh(3 * cells, cells, 1.0, 1.0);
    for (Vector<2>& x : mesh.nodes) x[0] *= 1.2 + 2.0 * (1.0 - x[1]);
    return mesh;
  }
};

constexpr double unit_weight = 2e4;  ///< N/m3

NodalLoads<2> weight_of(const PlaneModel& m) {
  return m.weight_on(NodalLoads<2>(m.grid), unit_weight);
}

SafetyFactor slope_factor(int cells, double dilation, double young = 1e8, int threads = 1) {
  SlopeTwoToOne m(cells, mohr_coulomb_soil(20.0, 0.05 * unit_weight, dilation, young));
  m.threads = threads;
  return safety_factor(m, weight_of(m), 0.01);
}

TEST(Slope, HasTheFactorOfGriffithsAndLane) {
  // With full dilation the factor is an upper bound, which falls as the mesh is refined.
  const double coarse = slope_factor(4, 20.0).factor;
  const double fine = slope_factor(12, 20.0).factor;
  EXPECT_GT(coarse, fine);
  EXPECT_NEAR(fine, 1.4, 0.05);
}

/// A slope of 2:1 cut out of the points of a box: its surface lies inside elements.
struct SlopeInBox : PlaneModel {
  /// \param lump  whether a lump of soil lies on the crest and touches it at one node
  SlopeInBox(int cells, const SkeletonModel& soil, bool lump = false)
      : PlaneModel(model::crossed_mesh(14 * cells / 4, 5 * cells / 4, 3.5, 1.25), 3, soil,
                   [=](const Vector<2>& x) {
                     const double size = 1.0 / cells;
                     const Vector<2> from_lump = x - Vector<2>(0.5 + size / 6.0, 1.0 + size / 2.0);
                     return (x[1] < 1.0 && x[0] < 1.2 + 2.0 * (1.0 - x[1])) ||
                            (lump && from_lump.norm() < 0.25 * size);
                   }) {
    support("bottom", Support::both);
    support("left", Support::normal);
  }
};

TEST(Slope, WithItsSurfaceInsideElementsHasThisFactorToo) {
  const SlopeInBox m(12, mohr_coulomb_soil(20.0, 0.05 * unit_weight, 20.0));
  EXPECT_NEAR(safety_factor(m, weight_of(m), 0.01).factor, 1.4, 0.05);
}

/// Moved soil has such lumps. What they fall by says nothing about the slope.
TEST(Slope, WithALooseLumpOnItsCrestHasTheSameFactor) {
  const SkeletonModel soil = mohr_coulomb_soil(20.0, 0.05 * unit_weight, 20.0);
  const SlopeInBox clean(4, soil);
  const SlopeInBox loose(4, soil, true);
  const double factor = safety_factor(clean, weight_of(clean), 0.01).factor;
  const SafetyFactor found = safety_factor(loose, weight_of(loose), 0.01);
  std::cout << "factor " << factor << ", with a lump " << found.factor << '\n';
  EXPECT_NEAR(found.factor, factor, 0.01 * factor);
  EXPECT_LT(found.trials.front().displacement_max, 1.0);
}

TEST(Slope, WithoutDilationHasAFactorSlightlyLower) {
  const double associated = slope_factor(8, 20.0).factor;
  const double not_associated = slope_factor(8, 0.0).factor;
  EXPECT_LT(not_associated, associated);
  EXPECT_NEAR(not_associated, 1.4, 0.05);
}

TEST(Slope, HasTheSameFactorHoweverStiffTheSoil) {
  const SafetyFactor stiff = slope_factor(4, 20.0, 1e9);
  const SafetyFactor soft = slope_factor(4, 20.0, 1e5);
  EXPECT_EQ(stiff.factor, soft.factor);
  ASSERT_EQ(stiff.trials.size(), soft.trials.size());
  EXPECT_NEAR(soft.trials[0].displacement_max, 1e4 * stiff.trials[0].displacement_max,
              1e-6 * soft.trials[0].displacement_max);
}

TEST(Slope, HasTheSameFactorToTheLastBitOnTwoThreads) {
  const SafetyFactor one = slope_factor(8, 20.0);
  const SafetyFactor two = slope_factor(8, 20.0, 1e8, 2);
  ASSERT_EQ(one.trials.size(), two.trials.size());
  for (std::size_t k = 0; k < one.trials.size(); ++k) {
    EXPECT_EQ(one.trials[k].displacement_max, two.trials[k].displacement_max);
  }
}

TEST(Slope, OfElasticSoilNeverFailsAndOfSoilWithoutStrengthAlways) {
  SkeletonModel elastic = mohr_coulomb_soil(20.0, 0.0, 0.0);
  elastic.law = skeleton_law("elastic");
  const SlopeTwoToOne bears_all(4, elastic);
  const SafetyFactor none = safety_factor(bears_all, weight_of(bears_all), 0.01);
  EXPECT_EQ(none.factor, std::numeric_limits<double>::infinity());
  EXPECT_EQ(none.holds, 64.0);
  const SlopeTwoToOne mud(4, mohr_coulomb_soil(0.0, 1.0, 0.0));
  EXPECT_EQ(safety_factor(mud, weight_of(mud), 0.01).factor, 0.0);
}

// ---------------------------------------------------------------------- the end of a trial

/// Without dilation, Newton's method finds no equilibrium in most trials near the limit.
SafetyFactor slope_factor_with(const StrengthReductionLimits& limits) {
  const SlopeTwoToOne m(8, mohr_coulomb_soil(20.0, 0.05 * unit_weight, 0.0));
  const Supports<2> supports(m.grid, m.face_support);
  return find_safety_factor<2>(m.body(), supports, weight_of(m), {}, 1, limits);
}

TEST(Trial, ThatRunsOutOfIterationsIsNoFailure) {
  StrengthReductionLimits limits;
  limits.newton.max_iterations = 1;
  limits.settling_iterations = 3;
  const SafetyFactor none = slope_factor_with(limits);
  EXPECT_EQ(none.trials.back().end, Settling::undecided);
  EXPECT_GT(none.trials.back().residual, limits.newton.tolerance);
  EXPECT_GE(none.undecided_node, 0);
  EXPECT_EQ(none.factor, 0.0);
  EXPECT_TRUE(none.mechanism.empty());
}

TEST(Trial, IsDecidedInPseudoTimeAsByNewtonsMethod) {
  StrengthReductionLimits limits;
  const SafetyFactor both = slope_factor_with(limits);
  limits.newton.max_iterations = 0;
  const SafetyFactor alone = slope_factor_with(limits);
  EXPECT_EQ(both.holds, alone.holds);
  EXPECT_EQ(both.fails, alone.fails);
  EXPECT_EQ(both.undecided_node, -1);
}

TEST(PseudoTime, MovesSoilThatFailsAtAConstantSpeed) {
  SlopeTwoToOne m(8, mohr_coulomb_soil(20.0, 0.05 * unit_weight, 0.0));
  for (PointSkeleton& point : m.skeleton) {
    point.parameters = reduced_strength(point.parameters, 1.7);
    point.parameters.young *= 1e6;
  }
  const Supports<2> supports(m.grid, m.face_support);
  Equilibrium<2> equilibrium(m.body(), supports, 1);
  const NodeVectors<2> loads = m.weight(unit_weight);
  PseudoTime<2> time(equilibrium, loads);
  const SettledSoil<2> near = time.settle(m.no_loads(), {.far = 2e-8});
  const SettledSoil<2> far = time.settle(m.no_loads(), {.far = 8e-8});
  ASSERT_EQ(near.end, Settling::runs_away);
  ASSERT_EQ(far.end, Settling::runs_away);
  // No stress balances this share of the forces at any displacement.
  std::cout << "out of balance " << near.residual << ", " << far.residual << std::endl;
  EXPECT_NEAR(far.residual, near.residual, 0.05 * near.residual);
  EXPECT_GT(far.residual, 1e-9);  // the tolerance of soil at rest
}

/// How 60 iterations end that neither balance the forces nor move the soil far enough.
/// \param slow  m per unit of pseudo-time
Settling end_by_motion(double factor, double slow) {
  SlopeTwoToOne m(8, mohr_coulomb_soil(20.0, 0.05 * unit_weight, 0.0));
  for (PointSkeleton& point : m.skeleton) {
    point.parameters = reduced_strength(point.parameters, factor);
    point.parameters.young *= 1e6;
  }
  const Supports<2> supports(m.grid, m.face_support);
  Equilibrium<2> equilibrium(m.body(), supports, 1);
  const NodeVectors<2> loads = m.weight(unit_weight);
  PseudoTime<2> time(equilibrium, loads);
  const SettlingLimits<2> limits{.tolerance = 0.0, .far = 1.0, .slow = slow, .max_iterations = 60};
  return time.settle(m.no_loads(), limits).end;
}

TEST(PseudoTime, DecidesByTheMotionWhenItsIterationsEnd) {
  constexpr double elastic = 7e-11;  // m
  EXPECT_EQ(end_by_motion(1.5, 1e-4 * elastic), Settling::runs_away);
  EXPECT_EQ(end_by_motion(1.5, elastic), Settling::rests) << "so fast soil counts as at rest";
  EXPECT_EQ(end_by_motion(1.5, 0.0), Settling::undecided) << "no speed counts as rest";
  EXPECT_EQ(end_by_motion(1.3, 1e-4 * elastic), Settling::undecided) << "its time is short";
  EXPECT_EQ(end_by_motion(1.41, 1e-6 * elastic), Settling::undecided) << "it slows down";
  EXPECT_EQ(end_by_motion(1.41, 1e-3 * elastic), Settling::rests);
}

/// A vertical cut of height 1 m; the soil behind it and below it has the same extent.
struct VerticalCut : PlaneModel {
  VerticalCut(int cells, const SkeletonModel& soil) : PlaneModel(mesh_of(cells), 1, soil) {
    support("bottom", Support::both);
    support("left", Support::normal);
    support("right", Support::normal);
  }
  /// The box without its upper right part: the mesh ends with the soil.
  static Mesh<2> mesh_of(int cells) {
    const double h = 1.0 / cells;
    const int below = cells / 2;
    Mesh<2> mesh = model::crossed_mesh(2 * cells, cells + below, 2.0, (cells + below) * h);
    std::erase_if(mesh.elements, [&](const auto& nodes) {
      Vector<2> centre = Vector<2>::Zero();
      for (const int i : nodes) centre += mesh.nodes[i] / 3.0;
      return centre[0] > 1.5 && centre[1] > below * h;
    });
    mesh.element_region.resize(mesh.elements.size());
    for (BoundarySet<2>& set : mesh.boundaries) {
      std::erase_if(set.faces, [&](const auto& nodes) {
        const Vector<2> centre = 0.5 * (mesh.nodes[nodes[0]] + mesh.nodes[nodes[1]]);
        return centre[0] > 1.5 && centre[1] > below * h;
      });
    }
    return mesh;
  }
};

TEST(VerticalCut, FailsAtItsHeight) {
  const auto factor = [](int cells) {
    const VerticalCut m(cells, mohr_coulomb_soil(0.0, unit_weight, 0.0));
    return safety_factor(m, weight_of(m), 5e-3);  // gamma H/c is 1
  };
  const SafetyFactor coarse = factor(4);
  const SafetyFactor fine = factor(8);
  EXPECT_GT(coarse.holds, fine.fails);
  EXPECT_GT(fine.holds, 3.776);
  // The toe makes the error proportional to the size of cells.
  const double limit = 2.0 * fine.factor - coarse.factor;
  std::cout << "limit " << limit << std::endl;
  EXPECT_NEAR(limit, 3.776, 0.03 * 3.776);
}

/// The cut on ground of this depth, in two rows of cells.
struct CutOnGround : PlaneModel {
  CutOnGround(double depth, double young_share, const SkeletonLaw* law = nullptr)
      : PlaneModel(mesh_of(depth), 1, mohr_coulomb_soil(25.0, 0.15 * unit_weight, 25.0)) {
    support("bottom", Support::both);
    support("left", Support::normal);
    support("right", Support::normal);
    for (int p = 0; p < points.size(); ++p) {
      if (points.position[p][1] > 0.5) continue;
      skeleton[p].parameters.young *= young_share;
      if (law != nullptr) skeleton[p].law = law;
    }
  }
  static Mesh<2> mesh_of(double depth) {
    Mesh<2> mesh = VerticalCut::mesh_of(4);
    for (Vector<2>& x : mesh.nodes) {
      if (x[1] < 0.25) x[1] = 0.5 - depth + (depth - 0.25) * x[1] / 0.25;
    }
    return mesh;
  }
};

TEST(VerticalCut, HasAFactorThatNeitherDepthNorStiffnessOfTheGroundChanges) {
  const auto factor = [](const CutOnGround& m) {
    return safety_factor(m, weight_of(m), 5e-3).factor;
  };
  const double shallow = factor(CutOnGround(2.0, 1.0));
  const SkeletonLaw* const elastic = skeleton_law("elastic");
  EXPECT_NEAR(factor(CutOnGround(80.0, 1.0)), shallow, 0.01 * shallow);
  EXPECT_NEAR(factor(CutOnGround(2.0, 1e-4)), shallow, 0.01 * shallow);
  const double rock = factor(CutOnGround(2.0, 1.0, elastic));
  EXPECT_NEAR(factor(CutOnGround(80.0, 1.0, elastic)), rock, 0.01 * rock);
  EXPECT_NEAR(factor(CutOnGround(2.0, 1e5, elastic)), rock, 0.01 * rock);
}

}  // namespace strength_reduction_test
}  // namespace suffuse

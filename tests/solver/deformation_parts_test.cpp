/// Single parts of the solid's equilibrium: classes of elements, supports, forces and their
/// tangent, the motion of points.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "boundary/free_water.hpp"
#include "box_mesh.hpp"
#include "equilibrium/step_equilibrium.hpp"
#include "grid/near_element.hpp"
#include "motion/crossing_forces.hpp"
#include "motion/held_by_inertia.hpp"
#include "motion/point_motion.hpp"
#include "motion/soil_inertia.hpp"
#include "results/state_archive.hpp"
#include "solver/solid_model.hpp"

namespace suffuse {
namespace deformation_parts_test {

using model::PlaneModel;

TEST(SolidPoints, OfAnElementAscendWhateverTheirOrderWas) {
  const PointsByElement sorted(4, {2, 0, 2, 3, 0, 2});
  const auto of = [&](int e) {
    const auto span = sorted.of(e);
    return std::vector<int>(span.begin(), span.end());
  };
  EXPECT_EQ(of(0), (std::vector<int>{1, 4}));
  EXPECT_TRUE(sorted.is_empty(1));
  EXPECT_EQ(of(2), (std::vector<int>{0, 2, 5}));
  EXPECT_EQ(of(3), (std::vector<int>{3}));
}

TEST(ElementClasses, FullWhereAllAroundHoldPoints) {
  // Four rows of cells, soil in the lower three: the third row touches the empty one.
  const PlaneModel m(model::column_mesh(3, 4), 3, model::elastic_soil(1e6, 0.3),
                     [](const Vector<2>& x) { return x[1] < 0.75; });
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    const double y = element_centroid(m.mesh, e)[1];
    if (y < 0.5) {
      EXPECT_EQ(m.classes->full[e], 1.0) << e;
    } else {
      // At the sides, more than half of the neighbours of the surface are soil.
      EXPECT_LE(m.classes->full[e], y < 0.75 ? 0.7 : 0.0) << e;
    }
    EXPECT_DOUBLE_EQ(m.classes->scale[e], y > 0.75 ? 0.0 : 1.0);
  }
}

TEST(ElementClasses, GoOverFromFullToWhatThePointsFill) {
  // Inside, any filling counts as full; at the border, the filling itself counts.
  PlaneModel m(model::column_mesh(5, 5), 4, model::elastic_soil(1e6, 0.3));
  for (double& v : m.points.volume) v *= 0.625;
  m.sort();
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    const Vector<2> x = element_centroid(m.mesh, e);
    const bool inside = (x - Vector<2>(0.5, 0.5)).cwiseAbs().maxCoeff() < 0.1;
    EXPECT_NEAR(m.classes->full[e], inside ? 1.0 : 0.5, 1e-12);
    EXPECT_NEAR(m.classes->scale[e], inside ? 1.0 / 0.625 : 0.5 * (1.0 + 1.0 / 0.625), 1e-12);
  }
}

TEST(ElementClasses, DoNotJumpAsSoilSinks) {
  PlaneModel m(model::column_mesh(4, 8), 6, model::elastic_soil(1e6, 0.3),
               [](const Vector<2>& x) { return x[1] < 0.75; });
  std::vector<double> last(m.mesh.element_count(), 1.0);
  double largest = 0.0;
  for (int step = 0; step < 240; ++step) {
    for (int e = 0; e < m.mesh.element_count(); ++e) {
      if (step > 0) largest = std::max(largest, std::abs(m.classes->full[e] - last[e]));
      last[e] = m.classes->full[e];
    }
    for (Vector<2>& x : m.points.position) x[1] = std::max(1e-6, x[1] - 1e-3);
    for (int p = 0; p < m.points.size(); ++p) {
      m.points.element[p] = element_at(m.grid, m.points.element[p], m.points.position[p]);
    }
    m.sort();
  }
  EXPECT_LT(largest, 0.1);
}

TEST(Supports, LeaveDirectionsAlongFlatCurvedAndCorneredBoundaries) {
  // The upper side bends by 11 degrees at x = 0.5; the left one meets it at about a right angle.
  const Mesh<2> mesh = model::column_mesh(2, 1, 1.0, 1.0, [](const Vector<2>& x) {
    return Vector<2>(x[0], x[1] + (x[1] > 0.0 && x[0] == 0.5 ? 0.05 : 0.0));
  });
  const Grid<2> grid(mesh);
  std::vector<Support> on(grid.face_count(), Support::none);
  for (const auto& nodes : mesh.boundaries[0].faces) on[grid.find_face(nodes)] = Support::normal;
  for (const auto& nodes : mesh.boundaries[2].faces) on[grid.find_face(nodes)] = Support::normal;
  for (const auto& nodes : mesh.boundaries[3].faces) on[grid.find_face(nodes)] = Support::both;
  const Supports<2> supports(grid, on);
  const auto node = [&](double x, double y) {
    for (int i = 0; i < mesh.node_count(); ++i) {
      if ((mesh.nodes[i] - Vector<2>(x, y)).norm() < 1e-9) return i;
    }
    throw std::invalid_argument("no node there");
  };
  EXPECT_EQ(supports.free_count(node(0.5, 0.0)), 2);
  EXPECT_EQ(supports.free_count(node(0.0, 1.0)), 0);
  EXPECT_EQ(supports.free_count(node(1.0, 0.0)), 0);
  EXPECT_EQ(supports.free_count(node(0.0, 0.0)), 1);
  EXPECT_EQ(supports.directions(node(0.0, 0.0)).col(0), Vector<2>(0.0, 1.0));
  // The support is along the chord of the bend.
  EXPECT_EQ(supports.free_count(node(0.5, 1.05)), 1);
  EXPECT_NEAR(std::abs(supports.directions(node(0.5, 1.05))(0, 0)), 1.0, 1e-15);
}

TEST(Supports, InThreeDimensionsAreOrthonormal) {
  // A sheared box: its sides are oblique.
  const Mesh<3> mesh = model::box_mesh({2, 2, 2}, Vector<3>::Ones(), [](const Vector<3>& x) {
    return Vector<3>(x[0] + 0.3 * x[1] - 0.2 * x[2], x[1] + 0.4 * x[2], x[2] + 0.1 * x[0]);
  });
  const Grid<3> grid(mesh);
  std::vector<Support> on(grid.face_count(), Support::none);
  for (int f = 0; f < grid.face_count(); ++f) {
    if (grid.is_outer(f)) on[f] = Support::normal;
  }
  const Supports<3> supports(grid, on);
  std::array<int, 4> count{};
  for (int i = 0; i < mesh.node_count(); ++i) {
    const Eigen::Matrix3d& q = supports.directions(i);
    EXPECT_LE((q.transpose() * q - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    ++count[supports.free_count(i)];
    for (int k = grid.node_face_begin[i]; k < grid.node_face_begin[i + 1]; ++k) {
      const int f = grid.node_face[k];
      if (!grid.is_outer(f)) continue;
      for (int free = 0; free < supports.free_count(i); ++free) {
        EXPECT_NEAR(q.col(free).dot(grid.face_normal[f].normalized()), 0.0, 1e-14);
      }
    }
  }
  // Corners, edges, sides and the middle of the box.
  EXPECT_EQ(count, (std::array<int, 4>{8, 12, 6, 1}));
}

/// A stressed body in a box of tetrahedra or a square of triangles, part of which is empty.
template <int Dim>
struct StressedBody {
  Mesh<Dim> mesh;
  Grid<Dim> grid;
  SolidPoints<Dim> points;
  std::vector<PointSkeleton> skeleton;
  PointsByElement sorted;
  ElementClasses classes;
  Supports<Dim> supports;

  StressedBody(Mesh<Dim> mesh_in, const std::string& law)
      : mesh(std::move(mesh_in)),
        grid(mesh),
        points(stressed_points(mesh)),
        skeleton(points.size(), {skeleton_law(law), {1e6, 0.3, 0.5, 2e4, 0.1}}),
        sorted(mesh.element_count(), points.element),
        classes(grid, points, sorted),
        supports(grid, std::vector<Support>(grid.face_count(), Support::none)) {}

  static SolidPoints<Dim> stressed_points(const Mesh<Dim>& mesh) {
    std::vector<PointPlace<Dim>> places;
    std::vector<double> volume;
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (element_centroid(mesh, e)[0] > 0.75) continue;
      for (int j = 0; j <= Dim; ++j) {
        PointPlace<Dim> place{e, {}};
        place.barycentric.fill(FieldNodes<Dim>::far_vertex);
        place.barycentric[j] = FieldNodes<Dim>::near_vertex;
        places.push_back(place);
        volume.push_back(element_volume(mesh, e) / (Dim + 1) * (1.0 + 0.1 * j));
      }
    }
    SolidPoints<Dim> points(mesh, places, volume);
    for (int p = 0; p < points.size(); ++p) {
      Eigen::Matrix3d& b = points.skeleton[p].elastic_b;
      b.diagonal() << 0.96, 0.95 + 0.02 * std::sin(p), 0.97;
      b(0, 1) = b(1, 0) = 0.02 * std::cos(p);
    }
    return points;
  }

  [[nodiscard]] Equilibrium<Dim> equilibrium() const {
    const SoftStiffness soft{.strain = std::vector<double>(mesh.node_count(), 2.0)};
    return Equilibrium<Dim>({grid, points, sorted, skeleton, classes, soft}, supports, 1);
  }
  [[nodiscard]] NodeVectors<Dim> some_displacement(double amount, unsigned seed) const {
    std::mt19937_64 random(seed);
    NodeVectors<Dim> u(mesh.node_count());
    for (auto& v : u) {
      for (int d = 0; d < Dim; ++d) {
        v[d] = amount * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0);
      }
    }
    return u;
  }
  [[nodiscard]] std::vector<double> some_pressure() const {
    std::vector<double> pressure(mesh.element_count());
    for (int e = 0; e < mesh.element_count(); ++e) pressure[e] = 2e4 * std::sin(e);
    return pressure;
  }
};

template <int Dim>
Mesh<Dim> small_mesh();
template <>
Mesh<2> small_mesh() {
  return model::column_mesh(4, 3, 1.0, 1.0, model::jittered(0.05, 3));
}
template <>
Mesh<3> small_mesh() {
  return model::box_mesh({4, 2, 2}, Vector<3>::Ones(), model::disturbed(0.05));
}

/// Relative difference of the derivative from central differences with steps of `h`.
template <int Dim>
double tangent_error(const StressedBody<Dim>& body, double h) {
  Equilibrium<Dim> equilibrium = body.equilibrium();
  equilibrium.set_pressure(body.some_pressure());
  const NodeVectors<Dim> at = body.some_displacement(0.01, 1);
  const NodeVectors<Dim> along = body.some_displacement(0.1, 2);
  const auto forces_at = [&](double share) {
    NodeVectors<Dim> u = at;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += share * along[i];
    equilibrium.displace(u, false);
    return equilibrium.unknowns().components(equilibrium.forces());
  };
  const Eigen::VectorXd differences = (forces_at(h) - forces_at(-h)) / (2.0 * h);
  equilibrium.displace(at, true);
  Eigen::SparseMatrix<double> tangent;
  equilibrium.assemble(tangent);
  const Eigen::VectorXd product = tangent * equilibrium.unknowns().components(along);
  return (product - differences).norm() / product.norm();
}

TEST(Equilibrium, TangentIsTheDerivativeOfTheForces) {
  const StressedBody<2> flat(small_mesh<2>(), "elastic");
  EXPECT_LE(tangent_error(flat, 1e-4), 1e-7);
  EXPECT_NEAR(tangent_error(flat, 4e-2) / tangent_error(flat, 2e-2), 4.0, 0.3);
  const StressedBody<3> solid(small_mesh<3>(), "elastic");
  EXPECT_LE(tangent_error(solid, 1e-4), 1e-7);
  EXPECT_NEAR(tangent_error(solid, 4e-2) / tangent_error(solid, 2e-2), 4.0, 0.3);
}

TEST(Equilibrium, TangentOfYieldingSoilIsTheDerivativeToo) {
  EXPECT_LE(tangent_error(StressedBody<2>(small_mesh<2>(), "mohr-coulomb"), 1e-6), 1e-6);
  EXPECT_LE(tangent_error(StressedBody<3>(small_mesh<3>(), "mohr-coulomb"), 1e-6), 1e-6);
}

/// The work of elastic forces is a function of the displacement.
TEST(Equilibrium, TangentIsSymmetricWhereDilatationIsShared) {
  StressedBody<3> body(small_mesh<3>(), "elastic");
  for (PointSkeleton& of_point : body.skeleton) of_point.parameters.poisson = 0.45;
  Equilibrium<3> equilibrium = body.equilibrium();
  const NodeVectors<3> somehow = body.some_displacement(0.01, 1);
  ASSERT_NE(equilibrium.law_increments(somehow), increments_of(body.grid, somehow));
  equilibrium.displace(body.some_displacement(0.01, 1), true);
  Eigen::SparseMatrix<double> tangent;
  equilibrium.assemble(tangent);
  const Eigen::SparseMatrix<double> transposed = tangent.transpose();
  EXPECT_LE((tangent - transposed).norm(), 1e-13 * tangent.norm());
}

TEST(CrossingForces, KeepTheBalanceAndFadeWhileWaterLeavesTheElements) {
  const StressedBody<2> body(model::column_mesh(4, 2), "elastic");
  Equilibrium<2> equilibrium = body.equilibrium();
  equilibrium.set_pressure(body.some_pressure());
  equilibrium.displace(body.some_displacement(0.0, 1), false);
  const NodeVectors<2> loads = body.some_displacement(1e5, 2);
  const NodeVectors<2> forces = equilibrium.forces();
  CrossingForces<2> crossing;
  NodeVectors<2> carried = loads;
  crossing.add(0.0, carried);
  EXPECT_EQ(carried[7], loads[7]);  // there are no crossing forces yet
  EXPECT_TRUE(crossing.soft_stiffness(0.0).strain.empty());
  // Slow drainage on the left, fast on the right. The height of every element is 1/sqrt(20).
  std::vector<double> diffusivity;
  for (int e = 0; e < body.mesh.element_count(); ++e) {
    diffusivity.push_back(element_centroid(body.mesh, e)[0] < 0.5 ? 0.01 : 0.02);
  }
  crossing.find(body.grid, body.sorted, equilibrium, loads, diffusivity);
  for (const double duration : {0.0, 2.0}) {
    carried = loads;
    crossing.add(duration, carried);
    for (int i = 0; i < body.mesh.node_count(); ++i) {
      const double x = body.mesh.nodes[i][0];
      if (x > 0.8) continue;                                           // no soil around
      const double drainage = 1.0 / (20.0 * (x < 0.6 ? 0.01 : 0.02));  // h^2/c_v, s
      const double left = std::exp(-duration / (CrossingForces<2>::drainage_times * drainage));
      EXPECT_NEAR((carried[i] - (loads[i] + left * (forces[i] - loads[i]))).norm(), 0.0, 1e-9);
      EXPECT_NEAR(crossing.soft_stiffness(duration).strain[i], 2.0 * std::pow(left, 0.05), 1e-14);
    }
  }
}

template <int Dim>
void check_work_of_pressure() {
  const StressedBody<Dim> body(small_mesh<Dim>(), "elastic");
  Equilibrium<Dim> equilibrium = body.equilibrium();
  const NodeVectors<Dim> at = body.some_displacement(0.01, 1);
  const NodeVectors<Dim> along = body.some_displacement(0.1, 2);
  const double h = 1e-5;
  const auto volumes = [&](double share) {
    NodeVectors<Dim> u = at;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += share * along[i];
    std::vector<double> result;
    for (int e = 0; e < body.mesh.element_count(); ++e) {
      Eigen::Matrix<double, Dim, Dim> f = Eigen::Matrix<double, Dim, Dim>::Identity();
      for (int k = 0; k <= Dim; ++k) {
        f += u[body.mesh.elements[e][k]] * body.grid.shape_gradient[e][k].transpose();
      }
      result.push_back(body.grid.volume[e] * f.determinant());
    }
    return result;
  };
  const std::vector<double> more = volumes(h);
  const std::vector<double> less = volumes(-h);
  const std::vector<double> pressure = body.some_pressure();
  double work = 0.0;
  for (int e = 0; e < body.mesh.element_count(); ++e) {
    if (!body.sorted.is_empty(e)) work -= pressure[e] * (more[e] - less[e]) / (2.0 * h);
  }
  equilibrium.displace(at, false);
  const NodeVectors<Dim> without = equilibrium.forces();
  equilibrium.set_pressure(pressure);
  equilibrium.displace(at, false);
  const NodeVectors<Dim> with = equilibrium.forces();
  double found = 0.0;
  for (int i = 0; i < body.mesh.node_count(); ++i) found += (with[i] - without[i]).dot(along[i]);
  EXPECT_NEAR(found, work, 1e-8 * std::abs(work));
}

TEST(Equilibrium, PressureWorksOnTheVolumeOfElements) {
  check_work_of_pressure<2>();
  check_work_of_pressure<3>();
}

TEST(Equilibrium, ForcesOfABodyBalance) {
  const StressedBody<3> body(small_mesh<3>(), "elastic");
  Equilibrium<3> equilibrium = body.equilibrium();
  equilibrium.displace(body.some_displacement(0.01, 1), false);
  Vector<3> sum = Vector<3>::Zero();
  for (const Vector<3>& f : equilibrium.forces()) sum += f;
  EXPECT_LE(sum.norm(), 1e-13 * equilibrium.force_scale());
}

/// Relative difference of the elastic stiffness from the tangent of soil without stress.
double elastic_difference(double poisson) {
  StressedBody<3> body(small_mesh<3>(), "elastic");
  for (PointSkeleton& of_point : body.skeleton) of_point.parameters.poisson = poisson;
  for (SkeletonState& state : body.points.skeleton) state.elastic_b.setIdentity();
  Equilibrium<3> equilibrium = body.equilibrium();
  equilibrium.displace(NodeVectors<3>(body.mesh.node_count(), Vector<3>::Zero()), true);
  Eigen::SparseMatrix<double> tangent;
  Eigen::SparseMatrix<double> elastic;
  equilibrium.assemble(tangent);
  equilibrium.assemble_elastic(elastic);
  return (tangent - elastic).norm() / elastic.norm();
}

TEST(Equilibrium, ElasticStiffnessIsTheTangentWithoutStress) {
  EXPECT_LE(elastic_difference(0.3), 1e-14);
  EXPECT_LE(elastic_difference(0.45), 1e-14);  // elements share their dilatation
}

/// Patch test: an affine displacement of the border, with large strain and rotation, becomes that
/// of all nodes and gives every point the same stress.
TEST(Equilibrium, AffineDisplacementOfTheBorderGoesThroughAnIrregularMesh) {
  PlaneModel m(model::column_mesh(6, 6, 1.0, 1.0, model::jittered(0.05, 5)), 3,
               model::elastic_soil(1e6, 0.3));
  Eigen::Matrix2d f;
  f << 0.7, 0.15, -0.1, 0.7;
  // The shift is inwards, so that no point leaves the mesh.
  const Vector<2> shift(0.05, 0.2);
  NodeVectors<2> wanted;
  for (const Vector<2>& x : m.mesh.nodes) wanted.emplace_back(shift + f * x - x);
  std::vector<int> held;
  for (int k = 0; k < m.grid.face_count(); ++k) {
    if (!m.grid.is_outer(k)) continue;
    for (const int i : m.grid.face_nodes[k]) held.push_back(i);
  }
  NodeVectors<2> start = wanted;
  for (int i = 0; i < m.mesh.node_count(); ++i) {
    if (std::ranges::find(held, i) == held.end()) start[i] += 0.03 * std::sin(i) * shift;
  }
  const NewtonSolution<2> solution = m.step(m.no_loads(), start, held);
  ASSERT_TRUE(solution.converged);
  for (int i = 0; i < m.mesh.node_count(); ++i) {
    EXPECT_LE((solution.displacement[i] - wanted[i]).norm(), 1e-10) << i;
  }
  const auto exact = skeleton_response<2>(*m.skeleton[0].law, m.skeleton[0].parameters,
                                          {Eigen::Matrix3d::Identity()}, f);
  for (int p = 0; p < m.points.size(); ++p) {
    EXPECT_LE((m.stress(p) - exact.stress / f.determinant()).norm(), 1e-8 * exact.stress.norm());
    EXPECT_NEAR(m.points.volume[p] / m.points.reference_volume[p], f.determinant(), 1e-10);
  }
}

TEST(Equilibrium, SoilThatNothingHoldsIsRefused) {
  PlaneModel m(model::column_mesh(2, 2), 1, model::elastic_soil(1e6, 0.3));
  try {
    const NewtonSolution<2> solution = m.step(m.weight(1e3));
    FAIL() << "converged: " << solution.converged;
  } catch (const NumericalError& error) {
    EXPECT_STREQ(error.what(),
                 "the displacements could not be solved for: nothing holds the soil, or a piece of "
                 "it; fix a boundary that it lies on");
  }
}

TEST(PointMotion, RefusesAPointThatLeavesTheMeshAndKeepsTheOthers) {
  PlaneModel m(model::column_mesh(2, 2), 1, model::elastic_soil(1e6, 0.3));
  const std::vector<Vector<2>> before = m.points.position;
  NodeVectors<2> displacement(m.mesh.node_count(), Vector<2>(0.0, 0.45));
  try {
    move_points(m.grid, m.skeleton, displacement, increments_of(m.grid, displacement), m.points, 1);
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_STREQ(
        error.what(),
        "solid point 5 moves from (0.166667, 0.833333) to (0.166667, 1.28333), which is "
        "far outside the mesh; make the mesh larger, fix the boundary that it passes, or take "
        "shorter steps");
  }
  EXPECT_EQ(m.points.position, before);
}

/// A node of the air above soil that bulges into its elements has next to no soil to move.
TEST(PointMotion, TravelsWithTheShareOfTheNodesThatMove) {
  PlaneModel m(model::column_mesh(1, 1), 1, model::elastic_soil(1e6, 0.3));
  const int e = m.points.element[0];
  const auto& nodes = m.mesh.elements[e];
  constexpr double share = 0.05;
  m.points.position[0] = (1.0 - share) * m.mesh.nodes[nodes[0]] + share * m.mesh.nodes[nodes[1]];
  NodeVectors<2> displacement(m.mesh.node_count(), Vector<2>::Zero());
  displacement[nodes[1]] = Vector<2>(0.3, -0.4);
  for (int p = 1; p < m.points.size(); ++p) m.points.element[p] = e;
  for (int p = 1; p < m.points.size(); ++p) m.points.position[p] = m.mesh.nodes[nodes[2]];
  EXPECT_NEAR(largest_travel(m.grid, m.points, displacement),
              share * 0.5 * steepest_shape(m.grid, e), 1e-15);
}

TEST(PointMotion, SoilMayRiseALittleOverTheBorder) {
  PlaneModel m(model::column_mesh(2, 2), 1, model::elastic_soil(1e6, 0.3));
  const std::vector<Vector<2>> before = m.points.position;
  const NodeVectors<2> displacement(m.mesh.node_count(), Vector<2>(0.0, 0.4));
  move_points(m.grid, m.skeleton, displacement, increments_of(m.grid, displacement), m.points, 1);
  for (int p = 0; p < m.points.size(); ++p) {
    const Vector<2>& now = m.points.position[p];
    EXPECT_NEAR((now - before[p] - Vector<2>(0.0, 0.4)).norm(), 0.0, 1e-15);
    const auto at = barycentric(m.mesh, m.points.element[p], now);
    EXPECT_GE(*std::ranges::min_element(at), now[1] > 1.0 ? -0.5 : -1e-12);
  }
}

TEST(PointMotion, LooseSoilFillsNoMoreThanFourTimesItsVolume) {
  PlaneModel m(model::column_mesh(2, 2), 1, model::elastic_soil(1e6, 0.3));
  const std::vector<double> start = m.points.volume;
  const Increments<2> grows(m.mesh.element_count(), std::sqrt(1.5) * Eigen::Matrix2d::Identity());
  const Increments<2> shrinks(m.mesh.element_count(), std::sqrt(0.5) * Eigen::Matrix2d::Identity());
  const auto volume_after = [&](const Increments<2>& increments) {
    move_points(m.grid, m.skeleton, m.no_loads(), increments, m.points, 1);
    return m.points.volume[0] / start[0];
  };
  EXPECT_NEAR(volume_after(grows), 1.5, 1e-15);
  for (int step = 0; step < 5; ++step) volume_after(grows);
  EXPECT_EQ(m.points.volume[0], 4.0 * start[0]);
  EXPECT_NEAR(volume_after(shrinks), 2.0, 1e-15);
}

TEST(PointMotion, FindsElementsAcrossAMeshAndAroundCorners) {
  // The mesh lacks its upper right quarter: the straight way from there to the upper left is
  // outside.
  Mesh<2> mesh = model::column_mesh(8, 8, 1.0, 1.0, model::jittered(0.03, 4));
  std::erase_if(mesh.elements, [&](const auto& nodes) {
    Vector<2> centre = Vector<2>::Zero();
    for (const int i : nodes) centre += mesh.nodes[i] / 3.0;
    return centre[0] > 0.5 && centre[1] > 0.5;
  });
  mesh.element_region.resize(mesh.elements.size());
  const Grid<2> grid(mesh);
  for (int from = 0; from < mesh.element_count(); from += 7) {
    for (int to = 0; to < mesh.element_count(); ++to) {
      EXPECT_EQ(element_at(grid, from, element_centroid(mesh, to)), to);
    }
    EXPECT_EQ(element_at(grid, from, Vector<2>(0.8, 0.8)), -1);
  }
}

/// Soil below y = 0.5, loaded on top.
struct LoadedHalf : PlaneModel {
  LoadedHalf()
      : PlaneModel(model::column_mesh(4, 4), 3, model::elastic_soil(1e6, 0.3),
                   [](const Vector<2>& x) { return x[1] < 0.5; }) {
    std::vector<int> top;
    for (int f = 0; f < grid.face_count(); ++f) {
      if (std::abs(grid.face_centre(f)[1] - 0.5) < 1e-9 && grid.face_normal[f][0] == 0.0) {
        top.push_back(f);
      }
    }
    surface = LoadedSurface<2>(grid, sorted, top);
  }
  /// Moves the surface without the soil.
  void displace_surface(const Eigen::Matrix2d& gradient, const Vector<2>& shift) {
    NodeVectors<2> displacement;
    for (const Vector<2>& x : mesh.nodes) displacement.emplace_back(gradient * x + shift);
    surface.move(grid, sorted, displacement);
  }
  static Vector<2> sum(const NodeVectors<2>& loads) {
    Vector<2> all = Vector<2>::Zero();
    for (const Vector<2>& f : loads) all += f;
    return all;
  }
};

TEST(LoadedSurface, LoadsTheSoilBelowWithTheSameForceAndMoment) {
  LoadedHalf m;
  m.displace_surface(Eigen::Matrix2d::Zero(), Vector<2>(0.0, 0.2));  // in the next cell
  NodalLoads<2> on_nodes(m.grid);
  m.surface.add_traction(m.grid, m.sorted, Vector<2>(3.0, -8.0), on_nodes);
  const NodeVectors<2>& loads = on_nodes.forces();
  EXPECT_NEAR((LoadedHalf::sum(loads) - Vector<2>(3.0, -8.0)).norm(), 0.0, 1e-13);
  double moment = 0.0;
  for (int i = 0; i < m.mesh.node_count(); ++i) {
    moment += m.mesh.nodes[i][0] * loads[i][1] - m.mesh.nodes[i][1] * loads[i][0];
    if (m.mesh.nodes[i][1] > 0.6) {
      EXPECT_EQ(loads[i].norm(), 0.0);
    }
  }
  EXPECT_NEAR(moment, 0.5 * -8.0 - 0.7 * 3.0, 1e-13);
}

TEST(LoadedSurface, PressureFollowsItsAreaAndNormalAndATractionDoesNot) {
  LoadedHalf m;
  Eigen::Matrix2d f;
  f << 0.8, 0.1, -0.2, 0.9;
  m.displace_surface(f - Eigen::Matrix2d::Identity(), Vector<2>(0.05, 0.1));
  NodalLoads<2> pressed(m.grid);
  m.surface.add_pressures(
      m.grid, m.sorted, [](const Vector<2>&) { return 5.0; }, pressed);
  // The surface was from (0, 0.5) to (1, 0.5); its normal is to the left of this direction.
  const Vector<2> along = f * Vector<2>(1.0, 0.0);
  EXPECT_NEAR((LoadedHalf::sum(pressed.forces()) + 5.0 * Vector<2>(-along[1], along[0])).norm(),
              0.0, 1e-13);
  NodalLoads<2> pulled(m.grid);
  m.surface.add_traction(m.grid, m.sorted, Vector<2>(3.0, -8.0), pulled);
  EXPECT_NEAR((LoadedHalf::sum(pulled.forces()) - Vector<2>(3.0, -8.0)).norm(), 0.0, 1e-13);
}

TEST(LoadedSurface, RefusesToLeaveTheMeshOrItsSoil) {
  const auto message_of = [](const auto& action) {
    try {
      action();
    } catch (const NumericalError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  LoadedHalf m;
  EXPECT_EQ(message_of([&] { m.displace_surface(Eigen::Matrix2d::Zero(), Vector<2>(0.0, 1.6)); }),
            "the loaded surface moves to (0.197169, 2.1), which is far outside the mesh; make "
            "the mesh larger");
  LoadedHalf empty;
  empty.sorted = PointsByElement(empty.mesh.element_count(), {});
  NodalLoads<2> loads(empty.grid);
  EXPECT_EQ(message_of([&] {
              empty.surface.add_traction(empty.grid, empty.sorted, Vector<2>(0.0, 1.0), loads);
            }),
            "the loaded surface at (0.197169, 0.5) has lost its soil: there is none within 4 "
            "elements below");
}

/// A block falls, settles and is sheared; compares the state of the points as bytes.
class Course {
 public:
  explicit Course(int threads)
      : m_(model::column_mesh(40, 40, 1.0, 1.0, model::jittered(0.005, 2)), 4,
           model::elastic_soil(1e6, 0.3),
           [](const Vector<2>& x) { return x[1] < 0.5 && x[0] < 0.6; }) {
    m_.threads = threads;
    m_.support("bottom", Support::both);
    m_.support("left", Support::normal);
    m_.surface = LoadedSurface<2>(m_.grid, m_.sorted, upper_side());
  }
  void go(int from, int to) {
    for (int step = from; step < to; ++step) {
      NodalLoads<2> loads = m_.weight_on(NodalLoads<2>(m_.grid), 2e4 * (step + 1));
      m_.surface.add_traction(m_.grid, m_.sorted, Vector<2>(1e3, -4e3 * (step + 1)), loads);
      ASSERT_TRUE(m_.step(loads.forces()).converged);
    }
  }
  void archive(StateArchive& archive) {
    archive(m_.points, m_.surface);
    if (archive.restores()) m_.sort();
  }
  [[nodiscard]] std::vector<std::uint8_t> state() {
    StateArchive bytes;
    archive(bytes);
    return bytes.finish();
  }

 private:
  [[nodiscard]] std::vector<int> upper_side() const {
    std::vector<int> faces;
    for (int f = 0; f < m_.grid.face_count(); ++f) {
      const int left = m_.grid.face_left[f];
      const int right = m_.grid.face_right[f];
      if (right < 0 || m_.sorted.is_empty(left) == m_.sorted.is_empty(right)) continue;
      if (std::abs(m_.grid.face_normal[f][1]) > 0.9 * m_.grid.face_normal[f].norm()) {
        faces.push_back(f);
      }
    }
    return faces;
  }

  PlaneModel m_;
};

TEST(SolidStep, HasTheSameBitsOnAnyNumberOfThreads) {
  Course one(1);
  Course two(2);
  Course three(3);
  one.go(0, 4);
  two.go(0, 4);
  three.go(0, 4);
  EXPECT_EQ(one.state(), two.state());
  EXPECT_EQ(one.state(), three.state());
}

TEST(SolidStep, GoesOnFromItsArchiveToTheLastBit) {
  Course all(1);
  all.go(0, 6);
  Course part(1);
  part.go(0, 3);
  StateArchive bytes(part.state());
  Course rest(1);
  rest.archive(bytes);
  rest.go(3, 6);
  EXPECT_EQ(rest.state(), all.state());
}

/// Soil of uniform density that only inertia holds moves like a fluid: its mobility is dt/rho.
TEST(HeldByInertia, IsTheMobilityOfAFluidInShortSteps) {
  constexpr double density = 2000.0;
  constexpr double compressibility = 1e-6;  // 1/Pa
  constexpr double duration = 1e-3;
  const Mesh<2> mesh = model::crossed_mesh(8, 8, 1.0, 1.0);
  const Grid<2> grid(mesh);
  std::vector<double> mass(mesh.node_count(), 0.0);
  std::vector<double> drained;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (const int i : mesh.elements[e]) mass[i] += density * grid.volume[e] / 3.0;
    drained.push_back(compressibility * grid.volume[e]);
  }
  const std::vector<double> held = held_mobility(grid, drained, mass, duration);
  for (const double mobility : held) EXPECT_NEAR(mobility, duration / density, 1e-20);
  // In a long step stiffness holds the soil, with its drained compressibility.
  for (const double mobility : held_mobility(grid, drained, mass, 10.0)) EXPECT_EQ(mobility, 0.0);
  const std::vector<double> in_long_step = held_compressibility(grid, drained, mass, 10.0);
  const std::vector<double> in_short_step = held_compressibility(grid, drained, mass, 1e-5);
  const std::vector<double> in_half_step = held_compressibility(grid, drained, mass, 5e-6);
  for (std::size_t e = 0; e < drained.size(); ++e) {
    EXPECT_NEAR(in_long_step[e], drained[e], 1e-3 * drained[e]);
    EXPECT_NEAR(in_short_step[e] / in_half_step[e], 4.0, 1e-3);
  }
}

/// One point of next to no stiffness, nearly at a node of its element.
struct LonePoint {
  static constexpr double mass = 500.0;  // kg
  static constexpr double dt = 1e-2;     // s
  model::SolidModel<2> model{model::crossed_mesh(1, 1, 1.0, 1.0),
                             {{{1.0 - 2e-9, 1e-9, 1e-9}, 1.0}},
                             model::elastic_soil(1e-6, 0.0),
                             [](const Vector<2>& x) { return x[1] < 0.3; }};
  std::vector<int> nodes = std::vector<int>(model.mesh.elements[model.points.element[0]].begin(),
                                            model.mesh.elements[model.points.element[0]].end());
  std::vector<double> masses = std::vector<double>(model.mesh.node_count(), 0.0);

  LonePoint() {
    for (int a = 0; a < 3; ++a) masses[nodes[a]] = mass * (a == 0 ? 1.0 - 2e-9 : 1e-9);
  }
  /// Displacement in a step under loads, N, that starts at a velocity, m/s.
  [[nodiscard]] NodeVectors<2> moved(const NodeVectors<2>& loads, const Vector<2>& velocity) const {
    const Supports<2> supports(model.grid, model.face_support);
    Equilibrium<2> equilibrium(model.body(), supports, 1);
    // A step that is tried again with another length starts anew.
    for (const double length : {0.1 * dt, dt}) {
      equilibrium.set_inertia(masses, NodeVectors<2>(masses.size(), velocity), length);
    }
    const auto solution =
        EquilibriumSolver<2>(equilibrium).solve(loads, model.no_loads(), {.tolerance = 1e-14});
    return solution.displacement;
  }
};

TEST(Inertia, OfALightNodeIsThatOfItsElement) {
  const LonePoint lone;
  NodeVectors<2> loads = lone.model.no_loads();
  loads[lone.nodes[1]] = {1.0, 0.0};
  const NodeVectors<2> moved = lone.moved(loads, Vector<2>::Zero());
  // A hundredth of the element's mass moves, not a billionth; momentum is that of the load.
  const double of_element = LonePoint::dt * LonePoint::dt / LonePoint::mass;
  EXPECT_LT(moved[lone.nodes[1]].norm(), 500.0 * of_element);
  EXPECT_GT(moved[lone.nodes[1]].norm(), 50.0 * of_element);
  Vector<2> momentum = Vector<2>::Zero();
  for (const int i : lone.nodes) momentum += lone.masses[i] * moved[i] / LonePoint::dt;
  EXPECT_NEAR(momentum[0], LonePoint::dt, 1e-8 * LonePoint::dt);
  EXPECT_NEAR(momentum[1], 0.0, 1e-8 * LonePoint::dt);
}

TEST(Inertia, OfALightNodeDoesNotHoldAFreeFall) {
  const LonePoint lone;
  const Vector<2> g(0.0, -10.0);
  const Vector<2> start(3.0, 1.0);
  NodeVectors<2> loads = lone.model.no_loads();
  for (const int i : lone.nodes) loads[i] = lone.masses[i] * g;
  const NodeVectors<2> moved = lone.moved(loads, start);
  const Vector<2> falls = LonePoint::dt * (start + LonePoint::dt * g);
  for (const int i : lone.nodes) EXPECT_LT((moved[i] - falls).norm(), 1e-10 * falls.norm());
}

TEST(Inertia, OfWaterThatFillsTheRestOfAnElementActsAtItsNodesAlone) {
  constexpr double density = 1000.0;  // kg/m3
  LonePoint lone;
  model::SolidModel<2>& model = lone.model;
  model.points.volume[0] *= 0.25;
  const Supports<2> supports(model.grid, model.face_support);
  const StepEquilibrium<2> step(model.grid, model.points, model.skeleton, supports, 1);
  const int e = model.points.element[0];
  std::vector<double> mass = lone.masses;
  add_free_water_mass(model.grid, step.sorted(), step.equilibrium().soil_volumes(),
                      std::vector<double>(model.mesh.elements.size(), density), mass);
  const double rest = density * (model.grid.volume[e] - model.points.volume[0]);
  EXPECT_GT(rest, 0.0);
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const bool is_near = std::ranges::find(lone.nodes, static_cast<int>(i)) != lone.nodes.end();
    EXPECT_NEAR(mass[i] - lone.masses[i], is_near ? rest / 3.0 : 0.0, 1e-12 * rest);
  }
}

}  // namespace deformation_parts_test
}  // namespace suffuse

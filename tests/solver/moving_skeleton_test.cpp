/// The moving skeleton under given pore pressures: equilibrium, fluxes of soil and solid, points
/// that change their element, erosion, the stress at the start.

#include "motion/moving_skeleton.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <iostream>
#include <numbers>
#include <numeric>
#include <random>

#include "box_mesh.hpp"
#include "grid/face_flux.hpp"
#include "motion/element_gains.hpp"
#include "reference_table.hpp"
#include "solid/hole_filling.hpp"
#include "solid/rigid_skeleton.hpp"
#include "solver/solid_model.hpp"

namespace suffuse {
namespace moving_skeleton_test {

BoundaryCondition held(const std::string& name) {
  BoundaryCondition b;
  b.on = name;
  b.fix = Fixing::normal;
  return b;
}

/// A load on top that grows from 0 s to 1 s and then stays.
BoundaryCondition loaded(const std::string& name, double traction) {
  BoundaryCondition b;
  b.on = name;
  b.traction = VectorFunction{{{0.0, {0.0, 0.0, 0.0}}, {1.0, {0.0, traction, 0.0}}}};
  return b;
}

/// Soil between smooth walls, without gravity.
Scene oedometer_scene(const SkeletonModel& skeleton, double load) {
  Scene scene = model::paper_scene();
  scene.soils[0].skeleton = skeleton;
  scene.boundaries = {held("bottom"), held("left"), held("right"), loaded("top", -load)};
  return scene;
}

struct Body {
  Body(Mesh<2> mesh, const Scene& scene, int threads = 1)
      : input(model::make_case(std::move(mesh), scene)),
        grid(input.mesh),
        soils(input),
        solid(grid, soils, soils.exchange_span(false), threads) {}

  /// Forcing of a step; `pressure`: pore pressure per element, Pa.
  struct Forcing : MotionForcing {
    std::vector<double> pressure;
  };
  [[nodiscard]] Forcing forcing(double end, double duration, double pressure = 0.0,
                                double liquid_mass = 0.0) const {
    const std::size_t count = input.mesh.elements.size();
    return {{end, duration, std::vector<double>(count, liquid_mass)},
            std::vector<double>(count, pressure)};
  }
  /// Solves a step, starting from the last solution.
  const SolidMotion& move(const Forcing& forcing) {
    step = solid.start_step(forcing, std::move(step));
    return solid.solve(*step, forcing.pressure);
  }
  /// Commits the step that was solved last.
  SolidMotion commit() { return solid.commit(*std::exchange(step, {})).first; }
  /// Steps of equal length; the load grows in the first second.
  void run(double from, double to, int steps) {
    const double dt = (to - from) / steps;
    for (int k = 1; k <= steps; ++k) {
      ASSERT_TRUE(move(forcing(from + k * dt, dt)).converged);
      commit();
    }
  }
  [[nodiscard]] double stretch() const {
    const auto& v = solid.points().volume;
    const auto& v0 = solid.points().reference_volume;
    return std::reduce(v.begin(), v.end(), 0.0) / std::reduce(v0.begin(), v0.end(), 0.0);
  }
  [[nodiscard]] double solid_of_points() const {
    double sum = 0.0;
    for (int p = 0; p < soils.points().size(); ++p) sum += solid.state().solid_volume(p);
    return sum;
  }
  /// Volume of the solid of each element, m3.
  [[nodiscard]] std::vector<double> solid_of_elements() const {
    std::vector<double> result = solid.element_porosity();
    for (std::size_t e = 0; e < result.size(); ++e) result[e] = (1.0 - result[e]) * grid.volume[e];
    return result;
  }
  [[nodiscard]] std::vector<std::uint8_t> bytes() {
    StateArchive archive;
    solid.archive(archive);
    return archive.finish();
  }

  Case<2> input;
  Grid<2> grid;
  SoilMap<2> soils;
  MovingSkeleton<2> solid;
  std::optional<MotionStep<2>> step;
};

double total(const std::vector<double>& values) {
  return std::reduce(values.begin(), values.end(), 0.0);
}

/// Stretch s with ln s = -q s; q: load over modulus.
double stretch_under(double load_over_modulus) {
  double s = 1.0;
  for (int k = 0; k < 50; ++k) {
    s -= (std::log(s) + load_over_modulus * s) / (1.0 / s + load_over_modulus);
  }
  return s;
}

// ----------------------------------------------------------------------------------- equilibrium

TEST(MovingSkeleton, DrainedCompressionIsExactUnderAnyPressureThatTheLoadCarriesToo) {
  const SkeletonModel soil = model::elastic_soil(1e6, 0.3);
  const double modulus = soil.at(1.0).oedometer_modulus();
  for (const double pressure : {0.0, 3e5}) {
    Body b(model::column_mesh(2, 4, 0.5, 1.0, [](const Vector<2>& x) { return x; }),
           oedometer_scene(soil, 1e5 + pressure));
    ASSERT_TRUE(b.move(b.forcing(1.0, 1.0, pressure)).converged);
    b.commit();
    const double exact = stretch_under(1e5 / modulus);
    for (int p = 0; p < b.soils.points().size(); ++p) {
      const double stretch = b.solid.points().volume[p] / b.solid.points().reference_volume[p];
      EXPECT_NEAR(stretch, exact, 1e-8);
      EXPECT_NEAR(b.solid.effective_stress(p)(1, 1), -1e5, 1e-3);
      EXPECT_NEAR(b.solid.porosity()[p], 1.0 - 0.7 / exact, 1e-8);
      EXPECT_EQ(b.soils.points().volume[p], b.solid.points().volume[p]);
    }
  }
}

TEST(MovingSkeleton, ATryChangesNothingAndTheNextStartsFromIt) {
  Body b(model::column_mesh(2, 8), oedometer_scene(model::elastic_soil(1e6, 0.3), 1e5));
  const int first = b.move(b.forcing(1.0, 1.0, 2e4)).iterations;
  EXPECT_GE(first, 2);
  const Body untouched(model::column_mesh(2, 8),
                       oedometer_scene(model::elastic_soil(1e6, 0.3), 1e5));
  EXPECT_EQ(b.solid.points().position, untouched.solid.points().position);
  EXPECT_EQ(b.solid.effective_stress(0), untouched.solid.effective_stress(0));
  const auto before = b.bytes();  // with the factor that the first solution made
  EXPECT_EQ(b.move(b.forcing(1.0, 1.0, 2e4)).iterations, 0);
  EXPECT_LT(b.move(b.forcing(1.0, 1.0, 2.0001e4)).iterations, first);
  EXPECT_EQ(b.bytes(), before);
  // A solution depends on the path of the iteration only within the tolerance.
  const std::vector<double> face_volume = b.move(b.forcing(1.0, 1.0)).face_volume;
  Body same(model::column_mesh(2, 8), oedometer_scene(model::elastic_soil(1e6, 0.3), 1e5));
  const std::vector<double> direct = same.move(b.forcing(1.0, 1.0)).face_volume;
  for (std::size_t f = 0; f < direct.size(); ++f) EXPECT_NEAR(face_volume[f], direct[f], 1e-10);
}

/// A pore pressure p takes p of the load of 1e5 Pa: about the share p/1e5 is out of balance, as the
/// surface has sunk into its elements.
TEST(MovingSkeleton, StaysAfterItsInertiaUntilAHundredthOfTheLoadsIsOutOfBalance) {
  Body b(model::column_mesh(2, 8), oedometer_scene(model::elastic_soil(1e6, 0.3), 1e5));
  b.run(0.0, 1.0, 4);
  EXPECT_FALSE(b.solid.rests());
  b.solid.start_inertia();
  ASSERT_TRUE(b.move(b.forcing(1.001, 0.001)).converged);
  b.solid.take_velocities(*b.step);
  b.solid.end_inertia(0.01);
  b.commit();
  ASSERT_TRUE(b.solid.rests());

  const std::vector<Vector<2>> places = b.solid.points().position;
  const auto stays = [&](double pressure) {
    const Body::Forcing forcing = b.forcing(2.0, 1.0, pressure);
    b.step = b.solid.start_step(forcing, std::move(b.step));
    return b.solid.stays(*b.step, forcing.pressure);
  };
  EXPECT_FALSE(stays(1.4e3));
  ASSERT_TRUE(stays(0.7e3));
  EXPECT_EQ(b.commit().travel, 0.0);
  EXPECT_TRUE(b.solid.rests());
  EXPECT_EQ(b.solid.points().position, places);
  // What held the soil up counts from its rest on, not from step to step.
  EXPECT_FALSE(stays(1.5e3));
  ASSERT_TRUE(b.move(b.forcing(2.0, 1.0, 1.5e3)).converged);
  EXPECT_GT(b.commit().travel, 1e-4);
  EXPECT_FALSE(b.solid.rests());
}

TEST(MovingSkeleton, RefusesAStepThatPassesElements) {
  Body b(model::column_mesh(2, 40), oedometer_scene(model::elastic_soil(1e6, 0.0), 3e5));
  const SolidMotion& motion = b.move(b.forcing(1.0, 1.0));
  EXPECT_GT(motion.travel, max_travel);
  EXPECT_FALSE(motion.converged);
  EXPECT_LT(b.move(b.forcing(0.02, 0.02)).travel, max_travel);
}

/// Soil that falls freely gains g t^2 in the first step, and as much more in the next one.
TEST(MovingSkeleton, RefusesAStepThatGainsAFifthOfAnElementWithInertia) {
  Scene scene = oedometer_scene(model::elastic_soil(1e6, 0.0), 0.0);
  scene.boundaries = {held("left"), held("right")};
  scene.gravity = {0.0, -10.0, 0.0};
  Body b(model::column_mesh(2, 10, 0.2, 1.0, [](const Vector<2>& x) { return x; }), scene);
  b.solid.start_inertia();
  const double height = 0.1 / std::numbers::sqrt2;  // of an element
  const double quarter = std::sqrt(0.25 * height / 10.0);
  const SolidMotion& motion = b.move(b.forcing(quarter, quarter));
  EXPECT_NEAR(motion.travel, 0.25, 1e-8);
  EXPECT_FALSE(motion.converged);
  const double seventh = std::sqrt(0.14 * height / 10.0);
  ASSERT_TRUE(b.move(b.forcing(seventh, seventh)).converged);
  b.solid.take_velocities(*b.step);
  b.commit();
  EXPECT_TRUE(b.move(b.forcing(2.0 * seventh, seventh)).converged);
  EXPECT_NEAR(b.step->motion.travel, 0.28, 1e-8);
}

// ----------------------------------------------------------------------------------------- fluxes

template <int Dim>
void check_swept_volumes(const Mesh<Dim>& mesh) {
  const Grid<Dim> grid(mesh);
  std::vector<int> element(mesh.elements.size());
  std::iota(element.begin(), element.end(), 0);
  const PointsByElement sorted(mesh.element_count(), element);
  std::mt19937_64 random(5);
  const auto uniform = [&] { return 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0; };
  for (const double distort : {0.0, 0.03}) {
    // Turns by half a radian.
    Eigen::Matrix<double, Dim, Dim> turn = Eigen::Matrix<double, Dim, Dim>::Identity();
    turn.template topLeftCorner<2, 2>() << std::cos(0.5), -std::sin(0.5), std::sin(0.5),
        std::cos(0.5);
    NodeVectors<Dim> u;
    for (const Vector<Dim>& x : mesh.nodes) {
      u.push_back(turn * x - x);
      for (int d = 0; d < Dim; ++d) u.back()[d] += distort * uniform();
    }
    const std::vector<double> swept = swept_volumes(grid, sorted, u);
    for (int e = 0; e < mesh.element_count(); ++e) {
      Eigen::Matrix<double, Dim, Dim> f = Eigen::Matrix<double, Dim, Dim>::Identity();
      for (int a = 0; a <= Dim; ++a) {
        f += u[mesh.elements[e][a]] * grid.shape_gradient[e][a].transpose();
      }
      EXPECT_NEAR(outflow(grid, e, swept), grid.volume[e] * (f.determinant() - 1.0), 1e-15);
    }
  }
}

TEST(SweptVolumes, AddUpToTheGrowthOfElementsThatTurn) {
  check_swept_volumes<2>(model::column_mesh(4, 4, 1.0, 1.0, model::jittered(0.05, 3)));
  check_swept_volumes<3>(model::box_mesh({2, 2, 2}, Vector<3>::Ones(), model::disturbed(0.05)));
}

TEST(FaceBubbles, CarryAPressureJumpOverTheirOwnStiffness) {
  const SkeletonModel soil = model::elastic_soil(1e6, 0.2);
  model::PlaneModel m(model::column_mesh(3, 3, 1.0, 1.0, model::jittered(0.05, 3)), 3, soil);
  m.support("bottom", Support::both);
  const Supports<2> supports(m.grid, m.face_support);
  StepEquilibrium<2> step(m.grid, m.points, m.skeleton, supports, 1);
  const FaceBubbles<2> bubbles(m.grid, step);
  std::vector<double> change(m.mesh.elements.size(), 7.0);
  std::vector<double> volume(m.grid.face_count(), 0.0);
  bubbles.add(change, volume);
  for (const double v : volume) EXPECT_NEAR(v, 0.0, 1e-20);
  const int e = 8;
  change[e] += 1e3;
  bubbles.add(change, volume);
  const SkeletonParameters numbers = soil.at(1.0);
  for (int k = 0; k < 3; ++k) {
    const int f = m.grid.element_face[e][k];
    if (m.grid.is_outer(f)) continue;
    const double length = m.grid.face_normal[f].norm();
    const Vector<2> n = m.grid.face_normal[f] / length;
    // The energy of the unit bubble 4 N_1 N_2 n, whose gradients are linear, by the midpoint rule
    // on the sides.
    double stiffness = 0.0;
    for (const int side : {m.grid.face_left[f], m.grid.face_right[f]}) {
      const int opposite = m.grid.side_of(side, f);
      const int a = (opposite + 1) % 3;
      const int b = (opposite + 2) % 3;
      for (int middle = 0; middle < 3; ++middle) {
        const Vector<2> g = 4.0 * ((middle == b ? 0.0 : 0.5) * m.grid.shape_gradient[side][b] +
                                   (middle == a ? 0.0 : 0.5) * m.grid.shape_gradient[side][a]);
        Eigen::Matrix2d strain = 0.5 * (n * g.transpose() + g * n.transpose());
        stiffness += m.grid.volume[side] / 3.0 *
                     (numbers.lame() * strain.trace() * strain.trace() +
                      2.0 * numbers.shear_modulus() * strain.squaredNorm());
      }
    }
    const double out = m.grid.element_face_sign[e][k] * volume[f];
    EXPECT_NEAR(out, 1e3 * std::pow(2.0 / 3.0 * length, 2) / stiffness, 1e-12 * out);
    EXPECT_GT(out, 0.0);
  }
}

TEST(SolidGains, StayInTheirPieceAndLeaveNoElementLessThanNothing) {
  const std::vector<double> before{0.0, 0.4, 0.6, 0.5};
  const std::vector<double> after{0.3, 0.3, 0.4, 0.5};
  const std::vector<double> solid{0.2, 0.3, 0.5, 0.5};  // their sum is that of the smooth volumes
  const std::vector<double> volume(4, 1.0);
  const std::vector<int> piece{0, 0, 0, 1};
  const auto gains = [&](double travel, const std::vector<double>& to) {
    return element_gains({before, to, solid, volume, travel, piece, 2});
  };
  for (const double gain : gains(0.0, before)) EXPECT_EQ(gain, 0.0);
  const std::vector<double> some = gains(0.25, after);
  EXPECT_NEAR(some[0], 0.3 - 0.25 * 0.2, 1e-15);
  EXPECT_NEAR(some[1], -0.1 + 0.25 * 0.1, 1e-15);
  EXPECT_NEAR(total(some), 0.0, 1e-15);
  EXPECT_EQ(some[3], 0.0);
  // The first difference is 0.2, the others -0.1: the second element may keep half of its
  // difference.
  const std::vector<double> little = gains(0.25, {0.5, 0.05, 0.45, 0.5});
  EXPECT_NEAR(solid[1] + little[1], 0.0, 1e-15);
  EXPECT_NEAR(solid[0] + little[0], 0.6, 1e-15);
  EXPECT_NEAR(total(little), 0.0, 1e-15);
}

/// A column whose porosity depends on the height sinks through its elements.
Scene sinking_scene() {
  Scene scene = oedometer_scene(model::elastic_soil(1e6, 0.2), 3e5);
  scene.soils[0].porosity_gradient = {0.02, 0.05, 0.0};
  return scene;
}

/// Pieces of soil that have met share the difference of their smooth volumes: gains in each piece
/// still add up to zero.
TEST(SolidFlux, GainsOfAPieceAddUpToNothing) {
  const std::vector<double> before{0.5, 0.3, 0.2, 0.4, 0.6, 0.0};
  const std::vector<double> after{0.4, 0.45, 0.25, 0.5, 0.55, 0.0};
  const std::vector<double> solid{0.52, 0.29, 0.21, 0.41, 0.57, 0.0};
  const std::vector<double> volume(before.size(), 1.0);
  const std::vector<int> piece{0, 0, 0, 1, 1, -1};
  const std::vector<double> gain = element_gains({before, after, solid, volume, 0.1, piece, 2});
  EXPECT_NEAR(gain[0] + gain[1] + gain[2], 0.0, 1e-16);
  EXPECT_NEAR(gain[3] + gain[4], 0.0, 1e-16);
  EXPECT_EQ(gain[5], 0.0);
  EXPECT_LT(gain[0], 0.0);
  EXPECT_GT(gain[1], 0.0);
}

/// Where a point lies beyond a side of its element by round-off, the smooth volume of an element
/// may be below zero. This does not change the gains of other elements.
TEST(SolidFlux, AnElementWithLessThanNothingByRoundOffChangesNothingElse) {
  const std::vector<double> before{0.5, 0.3, 0.0};
  const std::vector<double> after{0.4, 0.4, -1e-11};
  const std::vector<double> solid{0.52, 0.28, 1e-20};
  const std::vector<double> volume(before.size(), 1.0);
  const std::vector<int> piece{0, 0, 0};
  const std::vector<double> gain = element_gains({before, after, solid, volume, 0.1, piece, 1});
  EXPECT_NEAR(solid[0] + gain[0], 0.4 + 0.9 * 0.02, 1e-10);
  EXPECT_NEAR(solid[1] + gain[1], 0.4 - 0.9 * 0.02, 1e-10);
  EXPECT_NEAR(solid[2] + gain[2], 0.0, 1e-10);
}

/// The motion leaves nothing in the second element; the difference of the sums is another one's.
TEST(SolidFlux, AnElementWithoutSolidTakesNoPartOfTheDifference) {
  const std::vector<double> before{0.5, 0.3};
  const std::vector<double> after{0.4, 0.05};
  const std::vector<double> solid{0.52, 0.2};
  const std::vector<double> volume(before.size(), 1.0);
  const std::vector<int> piece{0, 0};
  const std::vector<double> gain = element_gains({before, after, solid, volume, 0.1, piece, 1});
  EXPECT_NEAR(solid[0] + gain[0], 0.72, 1e-15);
  EXPECT_NEAR(solid[1] + gain[1], 0.0, 1e-16);
}

TEST(SolidFlux, ClosesToRoundOffWhileASoftColumnSinksThroughElements) {
  Body b(model::column_mesh(3, 12, 0.25, 1.0), sinking_scene());
  const double solid = b.solid_of_points();
  EXPECT_NEAR(total(b.solid_of_elements()), solid, 1e-14);
  double largest = 0.0;
  for (int k = 1; k <= 40; ++k) {
    ASSERT_TRUE(b.move(b.forcing(k / 40.0, 1.0 / 40.0)).converged);
    const std::vector<double> before = b.solid_of_elements();
    const SolidMotion motion = b.commit();
    const std::vector<double> after = b.solid_of_elements();
    EXPECT_NEAR(total(motion.solid_gain), 0.0, 1e-16);
    for (int e = 0; e < b.input.mesh.element_count(); ++e) {
      EXPECT_NEAR(outflow(b.grid, e, motion.solid_face_volume), -motion.solid_gain[e], 1e-17);
      EXPECT_NEAR(after[e], before[e] + motion.solid_gain[e], 1e-17);
      EXPECT_GE(after[e], -1e-15);
    }
    for (int f = 0; f < b.grid.face_count(); ++f) {
      if (b.grid.is_outer(f)) {
        EXPECT_EQ(motion.solid_face_volume[f], 0.0);
      }
    }
    largest = std::max(largest, motion.solid_correction);
  }
  std::cout << "largest correction of the solid's flux " << largest << "\n";
  EXPECT_LE(largest, 0.6);
  EXPECT_NEAR(total(b.solid_of_elements()), solid, 1e-14);
  EXPECT_NEAR(b.solid_of_points(), solid, 1e-15);
}

/// A surface that another run has left is that of the same boundary only if it began on the same
/// faces: a traction acts on the faces of its own scene.
TEST(BoundaryLoads, TakeTheSurfacesOfTheSameFacesOnly) {
  const double load = 8.0;
  const Scene scene = oedometer_scene(model::elastic_soil(1e6, 0.2), load);
  const Mesh<2> whole = model::column_mesh(4, 4);
  Mesh<2> part = whole;
  for (BoundarySet<2>& set : part.boundaries) {
    if (set.name != "top") continue;
    std::erase_if(set.faces, [&](const auto& face) { return whole.nodes[face[0]][0] > 0.45; });
    ASSERT_EQ(set.faces.size(), 2U);
  }
  const Body on_whole(whole, scene);
  const Body on_part(part, scene);
  const auto start = [](const Body& b) {
    return BoundaryLoads<2>(b.grid, b.soils,
                            PointsByElement(b.grid.mesh.element_count(), b.soils.points().element));
  };
  const auto force = [](const Body& b, const BoundaryLoads<2>& loads) {
    const PointsByElement sorted(b.grid.mesh.element_count(), b.soils.points().element);
    NodalLoads<2> on_nodes(b.grid);
    loads.add(sorted, b.grid.volume, 1.0, on_nodes);
    double sum = 0.0;
    for (const Vector<2>& f : on_nodes.forces()) sum += f[1];
    return sum;
  };
  BoundaryLoads<2> of_part = start(on_part);
  EXPECT_NEAR(force(on_part, of_part), -0.5 * load, 1e-12);
  of_part.place(start(on_whole).surfaces());
  EXPECT_NEAR(force(on_part, of_part), -0.5 * load, 1e-12);
  BoundaryLoads<2> of_whole = start(on_whole);
  of_whole.place(start(on_part).surfaces());
  EXPECT_NEAR(force(on_whole, of_whole), -load, 1e-12);
  // Surfaces of the same faces are taken where they are.
  BoundaryLoads<2> moved = start(on_whole);
  const PointsByElement sorted(whole.element_count(), on_whole.soils.points().element);
  moved.move(sorted, NodeVectors<2>(whole.nodes.size(), Vector<2>(0.0, -0.1)));
  of_whole.place(moved.surfaces());
  EXPECT_NEAR(of_whole.surfaces().at("top").places().front()[1], 0.9, 1e-12);
}

/// Water above the soil of an element weighs once, however many boundaries the element has.
TEST(BoundaryLoads, WaterAboveSoilBesideTwoBoundariesWeighsOnce) {
  Scene scene = oedometer_scene(model::elastic_soil(1e6, 0.2), 0.0);
  scene.gravity = {0.0, -10.0, 0.0};
  const auto force = [&scene](Mesh<2> mesh, const std::vector<std::string>& names) {
    scene.boundaries.clear();
    for (const std::string& name : names) {
      scene.boundaries.emplace_back();
      scene.boundaries.back().on = name;
      scene.boundaries.back().head = TimeFunction{{{0.0, 3.0}}};
    }
    const Body b(std::move(mesh), scene);
    const PointsByElement sorted(b.grid.mesh.element_count(), b.soils.points().element);
    std::vector<double> soil_volume = b.grid.volume;
    for (double& volume : soil_volume) volume *= 0.5;
    NodalLoads<2> loads(b.grid);
    BoundaryLoads<2>(b.grid, b.soils, sorted).add(sorted, soil_volume, 1.0, loads);
    double sum = 0.0;
    for (const Vector<2>& f : loads.forces()) sum += f[1];
    return sum;
  };
  const Mesh<2> mesh = model::column_mesh(2, 2);
  Mesh<2> joined = mesh;
  BoundarySet<2> outer{"outer", {}};
  for (const BoundarySet<2>& set : mesh.boundaries) {
    if (set.name == "bottom") continue;
    outer.faces.insert(outer.faces.end(), set.faces.begin(), set.faces.end());
  }
  joined.boundaries = {outer};
  // Water of 2 m above the top, and in half of each of the five elements at these six faces.
  const double unit_weight = 1e4;
  const double weight = unit_weight * (2.0 + 5.0 / 8.0 * 0.5);
  EXPECT_NEAR(force(mesh, {"left", "right", "top"}), -weight, 1e-9 * weight);
  EXPECT_NEAR(force(joined, {"outer"}), -weight, 1e-9 * weight);
}

// ---------------------------------------------------------------------- points that cross elements

TEST(MovingPoints, KeepWhatIsTheirsWhenTheyAreSortedAnew) {
  Scene scene = sinking_scene();
  scene.soils[0].conductivity = 1e6;  // crossing forces vanish within a step
  Body b(model::column_mesh(3, 12, 0.25, 1.0), scene);
  const SolidState start = b.solid.state();
  const std::vector<double> porosity = b.solid.initial_porosity();
  // Compares with the same motion without sorting.
  SolidPoints<2> points = b.solid.points();
  const Supports<2> supports = scene_supports(b.grid, b.soils);
  const PointSkeleton law{skeleton_law("elastic"), model::elastic_soil(1e6, 0.2).at(1.0)};
  const std::vector<PointSkeleton> skeleton(points.size(), law);
  BoundaryLoads<2> boundary(b.grid, b.soils,
                            PointsByElement(b.grid.mesh.element_count(), points.element));
  for (int k = 1; k <= 40; ++k) {
    StepEquilibrium<2> step(b.grid, points, skeleton, supports, 1);
    NodalLoads<2> loads(b.grid);
    boundary.add(step.sorted(), soil_volumes(points, step.sorted(), step.classes()), k / 40.0,
                 loads);
    ASSERT_TRUE(step.solve(loads.forces(), {}));
    boundary.move(step.sorted(), step.displacement());
    move_points(b.grid, skeleton, step.displacement(), step.law_increments(), points, 1);
    std::vector<Vector<2>> start_places = points.position;
    fill_holes(b.grid, supports, points, start_places);
  }
  b.run(0.0, 1.0, 40);
  int moved = 0;
  for (int p = 0; p < points.size(); ++p) {
    const int id = b.solid.id()[p];
    if (id != p) ++moved;
    EXPECT_EQ(b.soils.points().element[p], points.element[id]);
    EXPECT_NEAR((b.solid.points().position[p] - points.position[id]).norm(), 0.0, 1e-9);
    EXPECT_NEAR((b.solid.points().skeleton[p].elastic_b - points.skeleton[id].elastic_b).norm(),
                0.0, 1e-8);
    EXPECT_NEAR(b.solid.points().volume[p], points.volume[id], 1e-9 * points.volume[id]);
    EXPECT_EQ(b.solid.state().skeleton_volume[p], start.skeleton_volume[id]);
    EXPECT_EQ(b.solid.state().erodible_volume[p], start.erodible_volume[id]);
    EXPECT_EQ(b.solid.initial_porosity()[p], porosity[id]);
    if (p > 0) {
      EXPECT_LE(b.soils.points().element[p - 1], b.soils.points().element[p]);
    }
    EXPECT_NEAR((b.soils.points().position(b.input.mesh, p) - b.solid.points().position[p]).norm(),
                0.0, 1e-14);
  }
  EXPECT_GT(moved, points.size() / 2);
}

/// A hole takes a point of a neighbour. A closed space beside the soil is no hole, and rigid soil
/// neither gives points nor takes them.
TEST(MovingPoints, FillHolesAndNoSpaceThatSoilHasNeverFilled) {
  const Body b(model::column_mesh(4, 12, 0.25, 1.0), sinking_scene());
  const Mesh<2>& mesh = b.grid.mesh;
  Supports<2> closed(b.grid, std::vector<Support>(b.grid.face_count()));
  for (int i = 0; i < mesh.node_count(); ++i) closed.hold(i);
  const auto filled_after = [&](const Supports<2>& supports, const auto& is_left_out) {
    const SolidPoints<2>& all = b.solid.points();
    std::vector<PointPlace<2>> places;
    std::vector<double> volumes;
    for (int p = 0; p < all.size(); ++p) {
      const int e = all.element[p];
      if (is_left_out(e)) continue;
      places.push_back({e, barycentric(mesh, e, all.position[p])});
      volumes.push_back(all.volume[p]);
    }
    SolidPoints<2> points(mesh, places, volumes);
    std::vector<Vector<2>> start = points.position;
    fill_holes(b.grid, supports, points, start);
    return std::ranges::count_if(points.element, is_left_out);
  };
  const auto upper = [&](int e) { return element_centroid(mesh, e)[1] > 0.5; };
  EXPECT_EQ(filled_after(closed, upper), 0);
  constexpr int hole = 30;
  const auto one = [](int e) { return e == hole; };
  EXPECT_EQ(filled_after(closed, one), 1);
  Supports<2> rigid = closed;
  for (int k = 0; k < 3; ++k) {
    if (const int e = b.grid.across(hole, k); e >= 0) rigid.hold_element(mesh, e);
  }
  EXPECT_EQ(filled_after(rigid, one), 0);
}

/// Under a constant load, soil moves only as water leaves, even if many points have changed their
/// element.
TEST(MovingPoints, ThatCrossElementsDoNotMoveTheSoilAtOnce) {
  Body b(model::column_mesh(3, 12, 0.25, 1.0), sinking_scene());
  const PointsByElement start(b.input.mesh.element_count(), b.solid.points().element);
  b.run(0.0, 1.0, 40);
  const PointsByElement end(b.input.mesh.element_count(), b.solid.points().element);
  int emptied = 0;
  for (int e = 0; e < b.input.mesh.element_count(); ++e) {
    if (!start.is_empty(e) && end.is_empty(e)) ++emptied;
  }
  EXPECT_GT(emptied, 10);
  const double little = b.move(b.forcing(1.0, 1e-7)).travel;
  const double ten_times = b.move(b.forcing(1.0, 1e-6)).travel;
  EXPECT_LT(little, 1e-5);
  EXPECT_NEAR(ten_times, 10.0 * little, 0.03 * ten_times);
  EXPECT_GT(b.move(b.forcing(1.0, 10.0)).travel, 1e-4);  // what is out of balance fades
}

TEST(MovingPoints, KeepTheirSoilInAnotherRegion) {
  // Soft soil that erodes above a row of soil that does not.
  Mesh<2> mesh = model::column_mesh(2, 8);
  mesh.region_names = {"base", "specimen"};
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = element_centroid(mesh, e)[1] > 0.5 ? 1 : 0;
  }
  Scene scene = oedometer_scene(model::elastic_soil(1e6, 0.0), 4e5);
  scene.soils[0].erosion.law = erosion_law("constant");
  scene.soils[0].erosion.rate = 1e-3;
  scene.soils[0].erosion.start = 1.0;
  scene.soils.push_back(scene.soils[0]);
  scene.soils[1].region = "base";
  scene.soils[1].erosion = {};
  Body b(std::move(mesh), scene);
  b.run(0.0, 1.0, 40);
  std::vector<double> exchange;
  b.solid.exchange(1.0, 11.0, {}, {}, exchange);
  int strangers = 0;
  for (int p = 0; p < b.soils.points().size(); ++p) {
    const bool erodes = b.soils.soil_of_point(p).region == "specimen";
    if (erodes != (b.input.mesh.element_region[b.soils.points().element[p]] == 1)) ++strangers;
    EXPECT_NEAR(exchange[p], erodes ? 1e-2 * b.soils.points().volume[p] : 0.0, 1e-15);
  }
  EXPECT_GT(strangers, 0);
}

TEST(MovingSkeleton, IsRestoredToTheLastBit) {
  const auto mesh = [] { return model::column_mesh(3, 12, 0.25, 1.0); };
  Body whole(mesh(), sinking_scene());
  whole.run(0.0, 0.5, 20);
  const auto half = whole.bytes();
  whole.run(0.5, 1.0, 20);
  Body resumed(mesh(), sinking_scene());
  StateArchive archive(half);
  resumed.solid.archive(archive);
  archive.finish();
  EXPECT_EQ(resumed.soils.points().element.size(), whole.soils.points().element.size());
  resumed.run(0.5, 1.0, 20);
  EXPECT_EQ(resumed.bytes(), whole.bytes());
}

TEST(MovingSkeleton, HasTheSameBitsOnTwoThreads) {
  const auto course = [](int threads) {
    Scene scene = sinking_scene();
    scene.soils[0].erosion.law = erosion_law("first-order");
    scene.soils[0].erosion.rate = 0.1;
    Body b(model::column_mesh(28, 28, 1.0, 1.0, model::jittered(0.005, 2)), scene, threads);
    EXPECT_GT(b.soils.points().size(), 4096);
    std::vector<double> exchange;
    for (int k = 0; k < 2; ++k) {
      b.solid.exchange(0.02 * k, 0.02 * (k + 1), {}, {}, exchange);
      b.run(0.02 * k, 0.02 * (k + 1), 1);
    }
    return b.bytes();
  };
  EXPECT_EQ(course(1), course(2));
}

// ---------------------------------------------------------------------------------------- erosion

TEST(MovingSkeleton, OfStiffSoilIsTheRigidOne) {
  Scene scene = sinking_scene();
  scene.soils[0].erosion.law = erosion_law("first-order");
  scene.soils[0].erosion.rate = 0.1;
  const auto difference = [&](double young) {
    scene.soils[0].skeleton.young = young;
    Body b(model::column_mesh(3, 6, 0.5, 1.0), scene);
    const Case<2> same = model::make_case(b.input.mesh, scene);
    const SoilMap<2> soils(same);
    RigidSkeleton<2> reference(b.grid, soils, soils.exchange_span(false), 1);
    std::vector<double> exchange;
    double largest = 0.0;
    for (int k = 0; k < 10; ++k) {
      b.solid.exchange(k, k + 1, {}, {}, exchange);
      reference.exchange(k, k + 1, {}, {}, exchange);
      EXPECT_TRUE(b.move(b.forcing(k + 1, 1.0)).converged);
      for (const double v : b.commit().face_volume) {
        largest = std::max(largest, std::abs(v));
      }
    }
    const std::vector<double> porosity = b.solid.element_porosity();
    const std::vector<double> expected = reference.element_porosity();
    for (std::size_t e = 0; e < porosity.size(); ++e) {
      largest = std::max(largest, std::abs(porosity[e] - expected[e]));
    }
    for (std::size_t p = 0; p < exchange.size(); ++p) {
      largest = std::max(largest, std::abs(b.solid.porosity()[p] - reference.porosity()[p]));
    }
    return largest;
  };
  const double stiff = difference(1e10);
  const double stiffer = difference(1e12);
  std::cout << "E 1e10: " << stiff << ", 1e12: " << stiffer << "\n";
  EXPECT_NEAR(stiff / stiffer, 100.0, 2.0);
  EXPECT_LE(difference(1e20), 1e-13);
}

TEST(MovingSkeleton, SettlesAsItsFinesErode) {
  SkeletonModel soil = model::elastic_soil(1e6, 0.0);
  soil.young = FinesFunction({{1.0, 1e6}, {0.0, 4e5}});
  Scene scene = oedometer_scene(soil, 1e5);
  scene.soils[0].erosion.law = erosion_law("constant");
  scene.soils[0].erosion.rate = 1e-3;
  scene.soils[0].erosion.start = 1.0;
  const int rows = 64;
  Body b(model::column_mesh(1, rows, 1.0 / rows, 1.0), scene);
  b.run(0.0, 1.0, 40);
  // The rate is per present volume, so fines last longer than 0.1/1e-3 s.
  EXPECT_TRUE(b.solid.exchanges_within(110.0, 111.0));
  double now = 0.0;
  std::vector<double> exchange;
  double worst = 0.0;
  for (const ReferenceRow& row : read_reference("oedometer-eroding.csv")) {
    const double next = row.number("t");
    const int steps = next > now ? 20 : 0;
    for (int k = 0; k < steps; ++k) {
      const double dt = (next - now) / steps;
      const double from = 1.0 + now + k * dt;
      b.solid.exchange(from, from + dt, {}, {}, exchange);
      ASSERT_TRUE(b.move(b.forcing(from + dt, dt)).converged);
      b.commit();
    }
    now = next;
    const double error = b.stretch() / row.number("stretch") - 1.0;
    const double solid = b.solid_of_points() * rows;
    const double porosity = 1.0 - solid / b.stretch();
    const double left = total(b.solid.state().erodible_volume) / 0.1 * rows;
    std::cout << "t " << now << ": stretch off by " << error << ", n by "
              << porosity - row.number("n_L") << ", fines by " << left - row.number("erodible_left")
              << "\n";
    worst = std::max({worst, std::abs(error), std::abs(porosity - row.number("n_L")),
                      std::abs(left - row.number("erodible_left"))});
  }
  EXPECT_LE(worst, 1e-3);
}

TEST(MovingSkeleton, ShowsItsStateWhileAStepIsTried) {
  SkeletonModel soil = model::elastic_soil(1e6, 0.0);
  soil.young = FinesFunction({{1.0, 1e6}, {0.0, 4e5}});
  Body b(model::column_mesh(1, 4, 0.25, 1.0), oedometer_scene(soil, 1e5));
  b.run(0.0, 1.0, 4);
  const double left = b.solid.fines_left(0);
  const double stiffness = b.solid.stiffness();
  const std::vector<double> compressibility = b.solid.compressibility(1.0);
  const Eigen::Matrix3d stress = b.solid.effective_stress(0);
  const Body::Forcing without = b.forcing(2.0, 1.0);
  ASSERT_TRUE(b.move(without).converged);
  const double travel = b.move(without).travel;
  Body::Forcing eroding = without;
  eroding.porosity = b.solid.porosity();
  for (double& n : eroding.porosity) n += 0.05;
  ASSERT_TRUE(b.move(eroding).converged);
  EXPECT_GT(b.move(eroding).travel, travel + 1e-3);
  EXPECT_EQ(b.solid.fines_left(0), left);
  EXPECT_EQ(b.solid.stiffness(), stiffness);
  EXPECT_EQ(b.solid.compressibility(1.0), compressibility);
  EXPECT_EQ(b.solid.effective_stress(0), stress);
}

// ------------------------------------------------------------------------------------ at the start

/// Ground under water up to 1 m above it, with smooth sides.
struct Ground : Body {
  static constexpr double height = 2.0;
  static constexpr double level = 3.0;
  static Scene scene_of(const SkeletonModel& soil, std::optional<double> earth_pressure) {
    Scene scene = model::paper_scene();
    scene.gravity = {0.0, -9.81, 0.0};
    scene.soils[0].skeleton = soil;
    scene.earth_pressure = earth_pressure;
    BoundaryCondition top;
    top.on = "top";
    top.head = level;
    scene.boundaries = {held("bottom"), held("left"), held("right"), top};
    return scene;
  }
  explicit Ground(const SkeletonModel& soil, std::optional<double> earth_pressure = {},
                  Mesh<2> mesh = model::column_mesh(3, 8, 1.0, height))
      : Body(std::move(mesh), scene_of(soil, earth_pressure)) {
    at_rest = forcing(0.0, 0.0, 0.0, 300.0);
    for (int e = 0; e < input.mesh.element_count(); ++e) {
      at_rest.pressure[e] = 9810.0 * (level - element_centroid(input.mesh, e)[1]);
    }
    stands = solid.start_motion(at_rest.pressure, at_rest.liquid_mass).stands;
  }
  /// Means over the points of each row of elements: height, vertical and horizontal stress.
  [[nodiscard]] std::array<Eigen::Vector3d, 8> rows() const {
    std::array<Eigen::Vector3d, 8> result;
    for (Eigen::Vector3d& row : result) row.setZero();
    const double in_row = soils.points().size() / 8.0;
    for (int p = 0; p < soils.points().size(); ++p) {
      const double y = solid.points().position[p][1];
      const Eigen::Matrix3d stress = solid.effective_stress(p);
      Eigen::Vector3d& row = result[static_cast<int>(y / height * 8.0)];
      row += Eigen::Vector3d(y, stress(1, 1), stress(0, 0)) / in_row;
    }
    return result;
  }
  Forcing at_rest;
  bool stands = false;
};

TEST(StartMotion, CarriesTheBuoyantWeightWhereThePointsAre) {
  Ground g(model::elastic_soil(1e7, 0.25));
  EXPECT_TRUE(g.stands);
  for (const Eigen::Vector3d& row : g.rows()) {
    const double exact = -0.7 * 1700.0 * 9.81 * (g.height - row[0]);
    EXPECT_NEAR(row[1], exact, 1e-6 * std::abs(exact));
    EXPECT_NEAR(row[2], exact / 3.0, 0.02 * std::abs(exact));
  }
  for (int p = 0; p < g.soils.points().size(); ++p) {
    EXPECT_NEAR(
        (g.solid.points().position[p] - g.input.solid_points.position(g.input.mesh, p)).norm(), 0.0,
        1e-15);
    EXPECT_EQ(g.solid.points().volume[p], g.input.solid_points.volume[p]);
    EXPECT_EQ(g.solid.points().plastic_strain[p], 0.0);
  }
  // The ground is in equilibrium: the first step moves nothing.
  const SolidMotion& motion = g.move(g.at_rest);
  EXPECT_TRUE(motion.converged);
  EXPECT_LE(motion.travel, 1e-9);
}

TEST(StartMotion, TakesTheRatioOfStressesThatTheSceneGives) {
  Ground g(model::elastic_soil(1e7, 0.25), 0.6);
  for (const Eigen::Vector3d& row : g.rows()) {
    const double exact = -0.7 * 1700.0 * 9.81 * (g.height - row[0]);
    EXPECT_NEAR(row[1], exact, 1e-6 * std::abs(exact));
    EXPECT_NEAR(row[2], 0.6 * exact, 0.02 * std::abs(exact));
  }
  EXPECT_LE(g.move(g.at_rest).travel, 1e-9);
}

TEST(StartMotion, YieldsToTheActivePressure) {
  SkeletonModel soil = model::elastic_soil(1e7, 0.0);
  soil.law = skeleton_law("mohr-coulomb");
  soil.friction = 30.0;
  soil.cohesion = 10.0;
  Ground g(soil, {}, model::crossed_mesh(3, 8, 1.0, Ground::height));
  for (const Eigen::Vector3d& row : g.rows()) {
    const double exact = -0.7 * 1700.0 * 9.81 * (g.height - row[0]);
    EXPECT_NEAR(row[1], exact, 1e-6 * std::abs(exact));
    EXPECT_NEAR(row[2], exact / 3.0, 0.02 * std::abs(exact) + 20.0);
  }
}

TEST(StartMotion, SaysWhenThereIsNoEquilibrium) {
  SkeletonModel soil = model::elastic_soil(1e7, 0.3);
  soil.law = skeleton_law("von-mises");
  soil.cohesion = 1.0;
  Scene scene = oedometer_scene(soil, 0.0);
  scene.gravity = {0.0, -9.81, 0.0};
  scene.boundaries.erase(scene.boundaries.begin() + 1);  // the left side is free
  Body b(model::column_mesh(4, 4), scene);
  const Body::Forcing forcing = b.forcing(0.0, 0.0);
  EXPECT_FALSE(b.solid.start_motion(forcing.pressure, forcing.liquid_mass).stands);
}

}  // namespace moving_skeleton_test
}  // namespace suffuse

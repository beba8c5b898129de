/// How soil goes from equilibrium to inertia and back: each transition of the table in
/// docs/theory/moving-soil.md, "When soil fails".

#include "coupling/failure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solid/masses_in_motion.hpp"
#include "solver/solid_model.hpp"

namespace suffuse {
namespace failure_test {

constexpr double g = 9.81;

/// Heavy soil in a box of 1 m.
Scene heavy_scene() {
  Scene scene = model::paper_scene();
  scene.gravity = {0.0, -g, 0.0};
  scene.soils[0].skeleton = model::elastic_soil(1e6, 0.3);
  return scene;
}

struct Soil {
  explicit Soil(bool follows)
      : input(model::make_case(model::column_mesh(4, 4), heavy_scene())),
        grid(input.mesh),
        soils(input),
        solid(grid, soils, soils.exchange_span(false), 1),
        failure(grid, solid, follows) {}

  Case<2> input;
  Grid<2> grid;
  SoilMap<2> soils;
  MovingSkeleton<2> solid;
  Failure<2> failure;
};

/// Soil of 100 kg and 2 m, with this kinetic energy over its weight times its height.
SoilKinetics moving(double energy, double inertia_share = 0.0) {
  const SoilExtent soil{.mass = 100.0, .load = 100.0 * g, .height = 2.0};
  return {energy * soil.load * soil.height, inertia_share, soil};
}

const Unsolved no_equilibrium{"the soil has found no equilibrium", true};

/// The message that ends the run; empty if the run goes on.
template <class Act>
std::string end_of_run(const Act& act) {
  try {
    act();
  } catch (const NumericalError& error) {
    return error.what();
  }
  return "";
}

TEST(Failure, SoilThatDoesNotStandAtTheStartIsFollowedOrRefused) {
  Soil followed(true);
  followed.failure.start({.stands = true});
  EXPECT_FALSE(followed.failure.has_inertia());
  followed.failure.start({.stands = false});
  EXPECT_TRUE(followed.failure.has_inertia());
  EXPECT_EQ(followed.failure.time(), 0.0);
  Soil refused(false);
  EXPECT_EQ(end_of_run([&] { refused.failure.start({.stands = false}); }).substr(0, 42),
            "the soil has no equilibrium at the start: ");
  EXPECT_FALSE(refused.failure.has_inertia());
}

TEST(Failure, AShortestStepWithoutASolutionStartsInertiaOrEndsTheRun) {
  Soil followed(true);
  EXPECT_EQ(followed.failure.longest_travel(), Failure<2>::watched_travel);
  followed.failure.step_unsolved(3.0, no_equilibrium);
  EXPECT_TRUE(followed.failure.has_inertia());
  EXPECT_EQ(followed.failure.time(), 3.0);
  EXPECT_EQ(followed.failure.longest_travel(), max_travel);
  EXPECT_NE(end_of_run([&] {
              followed.failure.step_unsolved(4.0, no_equilibrium);
            }).find("the motion of the soil that fails has no solution"),
            std::string::npos);
  Soil stopped(false);
  EXPECT_EQ(stopped.failure.longest_travel(), max_travel);
  EXPECT_THROW(stopped.failure.step_unsolved(3.0, no_equilibrium), EquilibriumLost);
  EXPECT_FALSE(stopped.failure.has_inertia());
}

/// A short step or a slide starts inertia if the step before was long against the time of fall
/// through an element, unless a sudden change was announced in between.
TEST(Failure, ShortStepsOrASlideStartInertiaAfterLongOnes) {
  for (const bool slides : {false, true}) {
    Soil soil(true);
    const double fall = soil.solid.time_of_fall();
    EXPECT_NEAR(fall, std::sqrt(2.0 * mean_size(soil.grid.mesh) / g), 1e-15);
    const auto fails = [&](double time) {
      soil.failure.finish_step(time, (slides ? 1.0 : 0.9e-2) * fall, moving(slides ? 1.1e-4 : 0.0));
      return soil.failure.has_inertia();
    };
    EXPECT_FALSE(fails(1.0));
    soil.failure.finish_step(2.0, 1.1e-2 * fall, moving(0.9e-4));
    EXPECT_FALSE(soil.failure.has_inertia());
    soil.failure.expect_short_steps();
    EXPECT_FALSE(fails(3.0));
    soil.failure.finish_step(4.0, 1.1e-2 * fall, moving(0.0));
    EXPECT_TRUE(fails(5.0));
    EXPECT_EQ(soil.failure.time(), 5.0);
  }
  Soil stopped(false);
  stopped.failure.finish_step(1.0, 1.0, moving(0.0));
  stopped.failure.finish_step(2.0, 1e-9, moving(1.0));
  EXPECT_FALSE(stopped.failure.has_inertia());
}

/// Steps with inertia that together take next to no time get nowhere, at any time and again.
TEST(Failure, StepsThatStayShortGetNowhere) {
  Soil soil(true);
  const double fall = soil.solid.time_of_fall();
  const auto steps = [&](double dt) {
    for (int k = 0; k < 500; ++k) soil.failure.finish_motion(dt, moving(1e-3));
    return soil.failure.is_stuck();
  };
  soil.failure.step_unsolved(0.0, no_equilibrium);
  EXPECT_FALSE(steps(2.1e-6 * fall));
  EXPECT_TRUE(steps(1.9e-6 * fall));
  EXPECT_FALSE(steps(2.1e-6 * fall));
  soil.failure.finish_motion(fall, moving(1e-3));
  EXPECT_FALSE(steps(1e-9 * fall));
  EXPECT_TRUE(steps(1e-9 * fall));
  EXPECT_FALSE(Soil(true).failure.is_stuck());
}

/// In equilibrium the run gets nowhere if 200 trials of steps have no solution within 1 % of the
/// time since the start.
TEST(Failure, TrialsWithoutASolutionGetNowhere) {
  const auto try_steps = [](Soil& soil, double from, double to, int count) {
    for (int k = 0; k < count; ++k) {
      soil.failure.count_unsolved(from + (to - from) * k / (count - 1));
    }
    return soil.failure.is_stuck();
  };
  Soil followed(true);
  EXPECT_FALSE(try_steps(followed, 100.0, 300.0, 1000));
  EXPECT_FALSE(try_steps(followed, 400.0, 404.0, 199));
  EXPECT_TRUE(try_steps(followed, 500.0, 505.0, 200));
  followed.failure.step_unsolved(505.0, no_equilibrium);
  EXPECT_TRUE(followed.failure.has_inertia());
  EXPECT_FALSE(followed.failure.is_stuck());
  Soil stopped(false);
  EXPECT_TRUE(try_steps(stopped, 500.0, 505.0, 200));
  EXPECT_EQ(end_of_run([&] { stopped.failure.step_unsolved(505.0, {"no agreement"}); }),
            "t = 505 s: no agreement; since t = 500 s 200 steps have been shortened for want of a "
            "solution: soil that yields is about to lose its equilibrium");
}

/// Soil without motion has come to rest after sqrt(2 H/g), the time of a fall through its height.
TEST(Failure, SoilThatHasRestedForAFallHasNoInertiaAnyMore) {
  const double fall = std::sqrt(2.0 * 2.0 / g);
  Soil soil(true);
  soil.failure.step_unsolved(0.0, no_equilibrium);
  constexpr double dt = 0.01;
  double time = 0.0;
  const auto step = [&](const SoilKinetics& kinetics) {
    time += dt;
    soil.failure.finish_motion(dt, kinetics);
  };
  step(moving(0.0, 0.5));  // about to move
  for (int k = 0; k < 20; ++k) step(moving(1e-7, 1e-3));
  step(moving(2e-6, 1e-3));  // it moves again: the rest before does not count
  const double from = time;
  while (soil.failure.has_inertia() && time < 10.0) step(moving(1e-7, 1e-3));
  EXPECT_NEAR(time - from, fall, 2.0 * dt);
}

/// A bank that slides on ground of any mass, which hardly moves.
TEST(MassesInMotion, AreOfTheSoilThatSlides) {
  constexpr double mean = 38.0 / 18.0;  // of the ways, by mass times way
  for (const double ground : {0.0, 1e4, 1e9}) {
    const std::vector<double> moving =
        masses_in_motion({4e3, 4e3, 2e3, ground}, {1.0, 2.0, 3.0, 1e-8});
    EXPECT_NEAR(moving[0], 4e3 / mean, 4.0);
    EXPECT_NEAR(moving[1], 4e3 * 2.0 / mean, 4.0);
    EXPECT_EQ(moving[2], 2e3);
    EXPECT_LT(moving[3], 5.0);
  }
}

TEST(MassesInMotion, AreAllWhereAllMovesOrNothing) {
  for (const double way : {0.0, 1e-12, 3.0}) {
    const std::vector<double> moving = masses_in_motion({1.0, 5.0, 0.0}, {way, way, way});
    EXPECT_DOUBLE_EQ(moving[0], 1.0);
    EXPECT_DOUBLE_EQ(moving[1], 5.0);
    EXPECT_EQ(moving[2], 0.0);
  }
}

/// Layers of points of any height make up a column.
TEST(MassesInMotion, HaveTheHeightOfABlock) {
  const Vector<2> down(0.6, -0.8);
  for (const int layers : {1, 2, 7}) {
    SolidPoints<2> column;
    const double size = 3.5 / layers;
    for (int p = 0; p < layers; ++p) {
      column.position.emplace_back(Vector<2>(40.0, -7.0) + (p + 0.5) * size * down);
      column.volume.push_back(size * size);
    }
    EXPECT_NEAR(height_of_block(column, down, std::vector<double>(layers, 2e3)), 3.5, 1e-9);
    EXPECT_EQ(height_of_block(column, down, std::vector<double>(layers, 0.0)), 0.0);
  }
}

}  // namespace failure_test
}  // namespace suffuse

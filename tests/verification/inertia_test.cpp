/// Dry soil with inertia: waves, a thrown block, and a column that collapses.

#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "inertial_soil.hpp"
#include "reference_table.hpp"
#include "results/state_archive.hpp"

namespace suffuse {
namespace inertia_test {

using model::Collapse;
using model::CollapseResult;
using model::InertialLimits;
using model::InertialModel;
using model::InertialStep;

const auto everywhere = [](const Vector<2>&) { return true; };

// ------------------------------------------------------------------------------------------ waves

/// Wave speed in a column of height 1 that oscillates at its first frequency, with `steps` steps
/// per quarter of the period: the top stops after the time in which a wave travels up once.
double wave_speed(double modulus, double density, int rows, int steps, double exact) {
  InertialModel m(model::crossed_mesh(1, rows, 1.0 / rows, 1.0), model::elastic_soil(modulus, 0.0),
                  density, Vector<2>::Zero(), everywhere);
  for (const char* side : {"bottom", "left", "right"}) m.support(side, Support::normal);
  InertialLimits limits;
  limits.newton.tolerance = 1e-11;
  m.start_motion(limits);
  constexpr double k = 0.5 * std::numbers::pi;
  constexpr double amplitude = 1e-5;  // of the velocity, relative to that of the wave
  for (int p = 0; p < m.points.size(); ++p) {
    const double v = amplitude * exact;
    const double y = m.points.position[p][1];
    Eigen::Matrix2d gradient = Eigen::Matrix2d::Zero();
    gradient(1, 1) = v * k * std::cos(k * y);
    m.motion->velocities().set(p, {0.0, v * std::sin(k * y)}, gradient);
  }
  const double dt = 1.0 / exact / steps;
  const auto top = static_cast<int>(
      std::ranges::max_element(m.points.position, {}, [](const Vector<2>& x) { return x[1]; }) -
      m.points.position.begin());
  double before = m.motion->velocities().velocity(top)[1];
  for (;;) {
    m.move(dt);
    const double now = m.motion->velocities().velocity(top)[1];
    if (now <= 0.0) return 1.0 / (m.time - dt * now / (now - before));
    before = now;
  }
}

/// Liquid that drag couples to the grains moves with them, and its stiffness, K/n, is added to
/// theirs.
TEST(Waves, HaveTheSpeedOfTheReference) {
  double worst = 0.0;
  for (const ReferenceRow& row : read_reference("wave-speeds.csv")) {
    const double n = row.number("n");
    const double exact = row.number("c_undrained(inf drag)");
    const double modulus = row.number("Ec") + row.number("K") / n;
    const double density = modulus / (exact * exact);
    // Grains of 2700 kg/m3, water of 1000 kg/m3.
    EXPECT_NEAR(density, (1.0 - n) * 2700.0 + n * 1000.0, 1e-6);
    double last = 0.0;
    for (const int rows : {8, 16, 32}) {
      const double error =
          std::abs(wave_speed(modulus, density, rows, 4 * rows, exact) / exact - 1);
      std::cout << "c " << exact << ", " << rows << " rows: off by " << error << ", order "
                << (last > 0.0 ? std::log2(last / error) : 0.0) << "\n";
      if (last > 0.0) {
        EXPECT_GT(std::log2(last / error), 1.8);
      }
      last = error;
    }
    worst = std::max(worst, last);
  }
  EXPECT_LT(worst, 1e-3);
}

// ----------------------------------------------------------------------------------- thrown block

TEST(ThrownBlock, KeepsItsShapeAndFallsAsBackwardEulerDoes) {
  const Vector<2> g(0.0, -9.81);
  const Vector<2> start(1.5, 3.0);
  InertialModel m(model::crossed_mesh(24, 16, 3.0, 2.0), model::elastic_soil(1e6, 0.3), 1600.0, g,
                  [](const Vector<2>& x) { return x[0] < 0.5 && x[1] > 0.5 && x[1] < 1.0; });
  InertialLimits limits;
  limits.newton.tolerance = 1e-12;
  m.start_motion(limits);
  for (int p = 0; p < m.points.size(); ++p) {
    m.motion->velocities().set(p, start, Eigen::Matrix2d::Zero());
  }
  double mass = 0.0;
  for (const double of_point : m.mass) mass += of_point;
  Vector<2> velocity = start;
  Vector<2> way = Vector<2>::Zero();
  const std::vector<int> first = m.points.element;
  double momentum = 0.0;
  double place = 0.0;
  double stress = 0.0;
  while (m.time < 0.7) {
    const InertialStep step = m.move(0.01);
    velocity += step.duration * g;
    way += step.duration * velocity;
    Vector<2> error = -mass * velocity;
    for (int p = 0; p < m.points.size(); ++p) {
      error += m.mass[p] * m.motion->velocities().velocity(p);
    }
    momentum = std::max(momentum, error.norm() / (mass * start.norm()));
    for (int p = 0; p < m.points.size(); ++p) {
      place = std::max(place, (m.points.position[p] - m.start[p] - way).norm());
      stress = std::max(stress, m.stress(p).norm() / 1e6);
    }
  }
  std::cout << "momentum off by " << momentum << ", places by " << place << " m, stress over E "
            << stress << "\n";
  EXPECT_NE(m.points.element, first);
  EXPECT_LT(momentum, 1e-12);
  EXPECT_LT(place, 1e-12);
  EXPECT_LT(stress, 1e-12);
}

// --------------------------------------------------------------------------------------- collapse

/// Lube, Huppert, Sparks and Freundt (Phys. Rev. E 72 (2005) 041301): 1.2 a for a below 1.8.
TEST(Collapse, RunsOutAsFarAsSandDoesAndComesToRest) {
  const CollapseResult result = model::collapse({});
  std::cout << "run-out " << result.runout << ", height " << result.height << ", rests at "
            << result.time << " s, " << result.steps << " steps, " << result.iterations
            << " iterations a step, " << result.tries << " tries, volume " << result.volume << "\n";
  EXPECT_TRUE(result.rests);
  EXPECT_NEAR(result.runout, 1.2, 0.2 * 1.2);
}

/// A steep bank whose cohesion falls with its fines stands, fails, runs out, and stands again.
TEST(WeakeningBank, FailsRunsOutAndStandsAgain) {
  SkeletonModel soil = model::frictional_soil(1e6, 31.0);
  soil.cohesion = FinesFunction({{1.0, 8e3}, {0.0, 0.0}});
  InertialModel m(model::crossed_mesh(20, 10, 2.5, 1.25), soil, 1600.0, {0.0, -9.81},
                  [](const Vector<2>& x) { return x[0] < 1.0 && x[1] < 1.0; });
  m.support("left", Support::normal);
  m.support("right", Support::normal);
  m.support("bottom", Support::both);
  m.start_motion();
  const auto farthest = [&] {
    double x = 0.0;
    for (const Vector<2>& place : m.points.position) x = std::max(x, place[0]);
    return x;
  };
  const auto weaken_to = [&](double fines_left) {
    m.skeleton.assign(m.points.size(), {soil.law, soil.at(fines_left)});
  };
  int quasi_static = 0;
  int inertial = 0;
  double failed_at = -1.0;
  double standing = 0.0;
  for (int part = 20; part >= 0; --part) {
    weaken_to(0.05 * part);
    if (failed_at < 0.0 && m.step(m.loads()).converged) {
      ++quasi_static;
      standing = farthest();
      continue;
    }
    if (failed_at < 0.0) failed_at = 0.05 * part;
    for (bool rests = false; !rests && m.time < 20.0; ++inertial) {
      const InertialStep step = m.move(0.01);
      rests = m.time > 0.1 && SoilKinetics{m.energy(), step.inertia_share, m.extent(1.0)}.is_rest();
    }
  }
  std::cout << quasi_static << " steps in equilibrium, failure with " << failed_at
            << " of the fines left, " << inertial << " steps with inertia, at rest after " << m.time
            << " s at " << farthest() << " m, " << standing << " m before\n";
  // A vertical bank of height H needs c = gamma H / (3.83 tan(45 + phi/2)), 2318 Pa: 0.29 of 8 kPa.
  EXPECT_NEAR(failed_at, 0.27, 0.03);
  const double resting = farthest();
  EXPECT_TRUE(m.step(m.loads()).converged);
  EXPECT_NEAR(farthest(), resting, 1e-3);
  EXPECT_GT(quasi_static, 3);
  EXPECT_LT(m.time, 20.0);
  EXPECT_LT(standing, 1.1);
  EXPECT_GT(farthest(), 1.8);
}

TEST(Collapse, HasTheSameBitsOnTwoThreads) {
  Collapse c;
  c.end = 0.4;
  const CollapseResult one = model::collapse(c);
  c.threads = 2;
  EXPECT_EQ(model::collapse(c).places, one.places);
}

TEST(Collapse, GoesOnFromItsArchiveToTheLastBit) {
  const auto sand = [] {
    auto m = std::make_unique<InertialModel>(
        model::crossed_mesh(12, 5, 3.0, 1.25), model::frictional_soil(1e6, 31.0), 1600.0,
        Vector<2>(0.0, -9.81), [](const Vector<2>& x) { return x[0] < 1.0 && x[1] < 1.0; });
    for (const char* side : {"left", "bottom"}) m->support(side, Support::both);
    m->start_motion();
    return m;
  };
  const auto whole = sand();
  const auto part = sand();
  for (int step = 0; step < 60; ++step) whole->move(0.01);
  for (int step = 0; step < 30; ++step) part->move(0.01);
  StateArchive archive;
  archive(part->points, *part->motion);
  const auto rest = sand();
  StateArchive restored(archive.finish());
  restored(rest->points, *rest->motion);
  restored.finish();
  for (int step = 30; step < 60; ++step) rest->move(0.01);
  EXPECT_EQ(rest->points.position, whole->points.position);
  EXPECT_EQ(rest->energy(), whole->energy());
}

}  // namespace inertia_test
}  // namespace suffuse

/// Heads and gradients at probes and how far they can be off: what is exact is found exactly,
/// estimates hold against finer meshes, and the errors of a step are those of its causes.

#include "bounds/probe_means.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "bounds/disc_mean.hpp"
#include "grid/section_line.hpp"
#include "solver/random_ground.hpp"

namespace suffuse {
namespace probe_means_test {

using namespace random_ground;

template <int Dim>
void expect_whole(const DiscMean<Dim>& disc) {
  double sum = 0.0;
  for (const auto& part : disc.shares) sum += part.share;
  EXPECT_NEAR(sum, 1.0, 1e-14);
}

/// The mean of x over a disc in x > 0 by a wall at 0, of which the disc's centre is at 0: a half
/// disc has its centroid at 4 R / (3 pi), a half ball at 3 R / 8.
template <int Dim>
double centroid_of_half(Mesh<Dim> mesh, double radius) {
  const Grid<Dim> grid(mesh);
  Vector<Dim> centre = Vector<Dim>::Constant(0.47);
  centre[0] = 1e-12;
  const DiscMean<Dim> disc = disc_mean(grid, *find_place(grid, centre), radius);
  EXPECT_EQ(disc.radius, radius);
  expect_whole(disc);
  double result = 0.0;
  for (const auto& part : disc.shares) {
    result += part.share * (element_centroid(mesh, part.element)[0] + part.offset[0]);
  }
  return result;
}

TEST(DiscMean, IsThatOfItsPartInTheMesh) {
  const double half_disc = 4.0 * 0.3 / (3.0 * std::numbers::pi);
  EXPECT_NEAR(centroid_of_half(model::column_mesh(8, 8), 0.3), half_disc, 2e-3 * half_disc);
  EXPECT_NEAR(centroid_of_half(model::column_mesh(64, 64), 0.3), half_disc, 2e-4 * half_disc);
  const double half_ball = 3.0 * 0.3 / 8.0;
  EXPECT_NEAR(centroid_of_half(model::box_mesh({6, 6, 6}), 0.3), half_ball, 1e-2 * half_ball);
}

TEST(DiscMean, IsAsLargeAsItsElement) {
  Ground<2> ground;
  ground.mesh = model::column_mesh(4, 4);
  const Grid<2> grid(ground.mesh);
  const DiscMean<2> disc = disc_mean(grid, *find_place(grid, Vector<2>(0.3, 0.3)), 1e-6);
  EXPECT_GT(disc.radius, 0.05);
  expect_whole(disc);
}

/// Two squares that touch but share no node, as on both sides of a wall.
TEST(DiscMean, EndsAtWalls) {
  Mesh<2> mesh = model::column_mesh(8, 8);
  const Mesh<2> left = mesh;
  const int nodes = mesh.node_count();
  for (Vector<2> x : left.nodes) {
    x[0] += 1.0;
    mesh.nodes.push_back(x);
  }
  for (auto element : left.elements) {
    for (int& i : element) i += nodes;
    mesh.elements.push_back(element);
    mesh.element_region.push_back(0);
  }
  mesh.boundaries.clear();
  const Grid<2> grid(mesh);
  const DiscMean<2> disc = disc_mean(grid, *find_place(grid, Vector<2>(0.9, 0.5)), 0.3);
  for (const auto& part : disc.shares) {
    EXPECT_LT(element_centroid(mesh, part.element)[0], 1.0);
  }
}

template <int Dim>
OutputProbe probe_at(double x, double y, double disc) {
  return {.at = {x, y, Dim == 3 ? 0.5 : 0.0}, .disc = disc};
}

/// A uniform slope is exact on any mesh, with bedding across it too.
template <int Dim>
void expect_exact(Ground<Dim> ground) {
  ground.conductivity = {1e-4};
  ground.boundaries = {head_on("left", 2.0), head_on("right", 0.0)};
  ground.probes = {probe_at<Dim>(0.4, 0.5, 0.2)};
  const Found found = solve(ground);
  const ProbeMeans& means = *found.bounds.probes[0];
  EXPECT_EQ(means.radius, 0.2);
  EXPECT_NEAR(means.gradient.middle(), 2.0, 1e-10);
  EXPECT_LT(means.gradient.half(), 1e-6);
  // Samples place the rim of the disc.
  EXPECT_NEAR(means.head.middle(), 1.2, 1e-3);
  EXPECT_LT(means.head.half(), 1e-6);
}

TEST(ProbeMeans, AreExactInAUniformFlow) {
  Ground<2> square;
  square.mesh = model::column_mesh(6, 6, 1.0, 1.0, model::jittered(0.05, 3));
  expect_exact(square);
  DirectionalFactor<2> bedding;
  bedding.direction = {0.0, 0.9};
  square.bedding = {bedding};
  expect_exact(square);
  Ground<3> cube;
  cube.mesh = model::box_mesh({4, 4, 4});
  expect_exact(cube);
}

TEST(ProbeMeans, AreNoneWhereNoHeadIsHeld) {
  Ground<2> ground;
  ground.mesh = model::column_mesh(4, 4);
  ground.conductivity = {1e-4};
  ground.boundaries = {model::flux_on("left", 1e-5), model::flux_on("right", -1e-5)};
  ground.probes = {probe_at<2>(0.4, 0.5, 0.2)};
  EXPECT_FALSE(solve(ground).bounds.probes[0]);
}

TEST(ProbeMeans, HoldInRandomSections) {
  std::vector<double> effectivity;
  const auto compare = [&](const Interval& coarse, const Interval& fine, double margin,
                           unsigned seed) {
    const double error = std::abs(coarse.middle() - fine.middle());
    EXPECT_LE(error, coarse.half() + fine.half() + margin) << seed;
    EXPECT_LT(fine.half(), coarse.half()) << seed;
    effectivity.push_back(coarse.half() / error);
  };
  for (unsigned seed = 1; seed <= sections(); ++seed) {
    std::mt19937_64 random(seed);
    Ground<2> ground = random_square(random);
    // At the corner of four blocks, and across two.
    ground.probes = {probe_at<2>(0.5, 0.5, 0.2), probe_at<2>(0.3, 0.6, 0.1)};
    const Found coarse = solve(ground);
    for (int i = 0; i < 3; ++i) ground.mesh = refined(ground.mesh);
    const Found fine = solve(ground);
    for (std::size_t i = 0; i < 2; ++i) {
      const ProbeMeans& wide = *coarse.bounds.probes[i];
      const ProbeMeans& narrow = *fine.bounds.probes[i];
      // Samples place the rim of the disc to a hundredth of its radius.
      const double margin = 0.01 * wide.gradient.high;
      compare(wide.head, narrow.head, margin * wide.radius, seed);
      compare(wide.gradient, narrow.gradient, margin, seed);
    }
  }
  std::ranges::sort(effectivity);
  std::cout << "estimate over error " << effectivity[effectivity.size() / 10] << " to "
            << effectivity[effectivity.size() * 9 / 10] << " (10 to 90 %), median "
            << effectivity[effectivity.size() / 2] << ", least " << effectivity.front() << '\n';
}

/// Change of a discharge, a head and a gradient by a change of the conductivities: the flow with
/// those found anew differs from the estimate by terms of second order.
TEST(StepEstimates, AreWhatAChangeOfConductivitiesDoes) {
  std::array<double, 2> off{};
  for (int i = 0; i < 2; ++i) {
    const double size = i == 0 ? 1e-2 : 1e-3;
    std::mt19937_64 random(7);
    Ground<2> ground = random_square(random);
    for (int j = 0; j < 2; ++j) ground.mesh = refined(ground.mesh);
    ground.bedding.clear();
    for (double& conductivity : ground.conductivity) {
      conductivity = std::pow(10.0, uniform(random, -5.0, -4.0));
    }
    ground.boundaries = {head_on("middle", 2.0), head_on("bottom", 1.1)};
    ground.probes = {probe_at<2>(0.4, 0.5, 0.2)};
    LastStepErrors step;
    std::vector<double> change;
    for (std::size_t r = 0; r < ground.conductivity.size(); ++r) {
      change.push_back(size * uniform(random, -1.0, 1.0));
    }
    for (const int r : ground.mesh.element_region) step.conductivity.push_back(change[r]);
    const DischargeBounds now = solve(ground, step).bounds;
    for (std::size_t r = 0; r < change.size(); ++r) ground.conductivity[r] *= 1.0 + change[r];
    const DischargeBounds then = solve(ground).bounds;
    const auto compare = [&](const Interval& a, const Interval& b, const StepEstimates& estimate) {
      const double changed = std::abs(a.middle() - b.middle());
      EXPECT_EQ(estimate.time, 0.0);
      off[i] = std::max(off[i], std::abs(estimate.transport - changed) / std::abs(a.middle()));
    };
    EXPECT_GT(now.flux_out_step.transport, 0.05 * size * now.flux_out->middle());
    compare(*now.flux_out, *then.flux_out, now.flux_out_step);
    compare(*now.boundaries[1], *then.boundaries[1], now.boundary_steps[1]);
    compare(now.probes[0]->head, then.probes[0]->head, now.probes[0]->head_step);
    compare(now.probes[0]->gradient, then.probes[0]->gradient, now.probes[0]->gradient_step);
    EXPECT_LT(off[i], size * size);
  }
  std::cout << "off by " << off[0] << " and " << off[1] << '\n';
}

/// Errors of heads and fluxes in time add up as the numbers themselves do.
TEST(StepEstimates, AreSumsOfTheErrorsInTime) {
  Ground<2> ground;
  ground.mesh = model::column_mesh(6, 6);
  ground.conductivity = {1e-4};
  ground.boundaries = {head_on("left", 2.0), head_on("right", 0.0)};
  ground.probes = {probe_at<2>(0.4, 0.5, 0.2)};
  const Grid<2> grid(ground.mesh);
  LastStepErrors step;
  for (int f = 0; f < grid.face_count(); ++f) {
    step.face_pressure.push_back(9.81 * 1000.0 * 0.3 * grid.face_centre(f)[0]);
    step.face_flux.push_back(1e-6 * grid.face_normal[f][0]);
  }
  const DischargeBounds found = solve(ground, step).bounds;
  EXPECT_NEAR(found.boundary_steps[0].time, 1e-6, 1e-18);
  EXPECT_NEAR(found.flux_out_step.time, 1e-6, 1e-18);
  EXPECT_NEAR(found.probes[0]->head_step.time, 0.3 * 0.4, 1e-3);
  EXPECT_NEAR(found.probes[0]->gradient_step.time, 0.3, 1e-12);
}

}  // namespace probe_means_test
}  // namespace suffuse

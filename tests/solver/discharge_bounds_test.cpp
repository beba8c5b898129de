/// Bounds of the discharge: what they are between two heads, and that they hold against meshes that
/// are finer, in random ground.

#include "bounds/discharge_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "bounds/element_sizes.hpp"
#include "solver/random_ground.hpp"

namespace suffuse {
namespace discharge_bounds_test {

using namespace random_ground;

/// Largest violation of the bounds by those of a finer mesh, over the sum of all discharges: the
/// exact discharge lies in both.
double violation(const Found& coarse, const Found& fine) {
  EXPECT_EQ(coarse.bounds.why_estimates, "");
  EXPECT_EQ(fine.bounds.why_estimates, "");
  double scale = 0.0;
  for (const double q : fine.discharge) scale += std::abs(q);
  double largest = 0.0;
  for (std::size_t b = 0; b < coarse.discharge.size(); ++b) {
    const Interval& wide = *coarse.bounds.boundaries[b];
    const Interval& narrow = *fine.bounds.boundaries[b];
    largest = std::max({largest, wide.low - narrow.high, narrow.low - wide.high});
  }
  return largest / scale;
}

TEST(DischargeBounds, HoldInRandomSections) {
  double narrowest = 1e9;
  std::vector<double> effectivity;  // interval over the error of the mixed elements
  for (unsigned seed = 1; seed <= sections(); ++seed) {
    std::mt19937_64 random(seed);
    Ground<2> ground = random_square(random);
    const Found coarse = solve(ground);
    for (int i = 0; i < 3; ++i) ground.mesh = refined(ground.mesh);
    const Found fine = solve(ground);
    EXPECT_LE(violation(coarse, fine), 1e-10) << seed;
    for (std::size_t b = 0; b < coarse.discharge.size(); ++b) {
      const Interval& q = *coarse.bounds.boundaries[b];
      if (q.half() <= 1e-9 * std::abs(q.middle())) continue;
      narrowest = std::min(narrowest, q.half() / fine.bounds.boundaries[b]->half());
      const double error = std::abs(coarse.discharge[b] - fine.bounds.boundaries[b]->middle());
      effectivity.push_back(2.0 * q.half() / error);
    }
  }
  std::ranges::sort(effectivity);
  std::cout << "eight times finer: intervals at least " << narrowest
            << " times narrower; over the error of the mixed elements "
            << effectivity[effectivity.size() / 10] << " to "
            << effectivity[effectivity.size() * 9 / 10] << " (10 to 90 %), median "
            << effectivity[effectivity.size() / 2] << '\n';
  // Where four soils meet whose conductivities differ a million times, hardly.
  EXPECT_GT(narrowest, 1.2);
}

TEST(DischargeBounds, HoldInRandomBoxes) {
  for (unsigned seed = 1; seed <= sections() / 3; ++seed) {
    std::mt19937_64 random(seed);
    const Found coarse = solve(random_cube(random, 2));
    random.seed(seed);
    const Found fine = solve(random_cube(random, 8));
    EXPECT_LE(violation(coarse, fine), 1e-10) << seed;
  }
}

/// Between two heads they are the discharge of the mixed elements and the energy of the continuous
/// head.
TEST(DischargeBounds, BeginAtTheDischargeOfTheMixedElements) {
  std::mt19937_64 random(7);
  Ground<2> ground = random_square(random);
  for (const bool has_gravity : {false, true}) {
    ground.gravity = {0.0, has_gravity ? -9.81 : 0.0, 0.0};
    ground.boundaries = {head_on("middle", 2.0), head_on("bottom", 0.5)};
    const Found found = solve(ground);
    const Interval& out = *found.bounds.flux_out;
    // Intervals are wider for the round-off of what the best conductor could carry.
    const double margin = 1e-11 * out.low + 1e-12 * found.bounds.largest_flux;
    EXPECT_NEAR(out.low, found.discharge[1], margin);
    EXPECT_GT(out.half(), 0.01 * out.low);
    EXPECT_NEAR(found.bounds.boundaries[0]->high, -out.low, margin);
    double error = 0.0;
    for (const double of_element : found.bounds.error) error += of_element;
    EXPECT_NEAR(error, out.half(), 1e-9 * out.half());
  }
}

/// A third boundary with the head of the second changes nothing at the first: the dual is solved
/// for then, and no longer the flow itself.
TEST(DischargeBounds, AreTheSameByTheDualProblem) {
  std::mt19937_64 random(7);
  Ground<2> ground = random_square(random);
  ground.boundaries = {head_on("middle", 2.0), head_on("bottom", 0.5)};
  const Interval scaled = *solve(ground).bounds.flux_out;
  BoundarySet<2>& bottom = ground.mesh.boundaries[1];
  ground.mesh.boundaries.push_back({"rest", {bottom.faces.begin() + 4, bottom.faces.end()}});
  bottom.faces.resize(4);
  ground.boundaries.push_back(head_on("rest", 0.5));
  const Found found = solve(ground);
  EXPECT_NEAR(found.bounds.flux_out->low, scaled.low, 1e-3 * scaled.half());
  EXPECT_NEAR(found.bounds.flux_out->high, scaled.high, 1e-3 * scaled.half());
  EXPECT_GT(found.bounds.boundaries[0]->half(), 0.0);
  EXPECT_FALSE(found.bounds.boundaries[1]) << "touches the next one";
}

/// Where what leaves is given, what is not known is what enters under the head.
TEST(DischargeBounds, AreOfTheFluxThatIsNotGiven) {
  std::mt19937_64 random(7);
  Ground<2> ground = random_square(random);
  ground.gravity = {};
  ground.boundaries = {head_on("middle", 2.0), head_on("right", 0.0),
                       model::flux_on("left", -1e-3)};
  const Found found = solve(ground);
  const Interval& river = *found.bounds.boundaries[0];
  ASSERT_LT(found.discharge[1], 0.0) << "liquid enters at both heads";
  EXPECT_NEAR(found.bounds.flux_out->low, 1e-3, 1e-9);
  EXPECT_NEAR(found.bounds.flux_out->high, 1e-3, 1e-9);
  EXPECT_GT(river.half(), 0.0);
  EXPECT_NEAR(found.bounds.least_known->half(), river.half(), 1e-6 * river.half())
      << "that of both together is known by balance";
}

/// Uniform flow is exact: nothing is left between the bounds.
TEST(DischargeBounds, OfAUniformFlowMeet) {
  Ground<2> ground;
  ground.mesh = model::column_mesh(5, 5, 1.0, 1.0, model::jittered(0.05, 3));
  ground.conductivity = {1e-4};
  ground.boundaries = {head_on("left", 2.0), head_on("right", 0.0)};
  const Interval q = *solve(ground).bounds.flux_out;
  EXPECT_NEAR(q.middle(), 2e-4, 1e-15);
  EXPECT_LT(q.half(), 1e-11 * q.middle());
}

TEST(DischargeBounds, AreEstimatesWhereTheyProveNothing) {
  Ground<2> ground;
  ground.mesh = model::column_mesh(4, 4);
  ground.conductivity = {1e-4};
  ground.boundaries = {head_on("left", 2.0), head_on("top", 0.0)};
  EXPECT_NE(solve(ground).bounds.why_estimates.find("where these meet"), std::string::npos);
}

TEST(DischargeBounds, AreEstimatesWhereAWaterLevelEndsWithinABoundary) {
  Ground<2> ground;
  ground.mesh = model::column_mesh(4, 4);
  ground.conductivity = {1e-4};
  ground.gravity = {0.0, -9.81, 0.0};
  ground.boundaries = {head_on("left", 2.0), head_on("right", 0.6)};
  ground.boundaries[1].dry = DryPart::impervious;
  EXPECT_NE(solve(ground).bounds.why_estimates.find("water level"), std::string::npos);
  ground.boundaries[1].dry = DryPart::seepage;
  EXPECT_NE(solve(ground).bounds.why_estimates.find("seepage faces"), std::string::npos);
}

TEST(NextSizes, ShareTheErrorEvenly) {
  Ground<2> ground;
  ground.mesh = model::column_mesh(16, 16);
  const Grid<2> grid(ground.mesh);
  std::vector<double> error;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    error.push_back(std::exp(-4.0 * element_centroid(grid.mesh, e)[0]));
  }
  double whole = 0.0;
  for (const double of_element : error) whole += of_element;
  const std::vector<double> now = element_sizes(grid);
  const std::vector<double> next =
      next_sizes(grid, error, {.whole = 0.5 * whole, .max_elements = 1e9});
  for (int i = 0; i < grid.mesh.node_count(); ++i) {
    EXPECT_LT(next[i], 1.5 * now[0] * 1.0000001);
    EXPECT_GT(next[i], 0.35 * now[0] * 0.9999999);
  }
  EXPECT_LT(next.front(), 0.8 * now[0]);
  EXPECT_GT(next[16], now[0]);
  // Less than a fifth of the elements: as large as they may be.
  const std::vector<double> few =
      next_sizes(grid, error, {.whole = 1e-9 * whole, .max_elements = 10});
  double count = 0.0;
  for (const double size : few) EXPECT_NEAR(size, few.front(), 1e-9);
  for (const double of_element : now) count += std::pow(of_element / few.front(), 2.0);
  EXPECT_NEAR(count, 10.0, 1e-6);
}

}  // namespace discharge_bounds_test
}  // namespace suffuse

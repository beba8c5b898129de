/// Bounds of the discharge: what they are between two heads, and that they hold against meshes that
/// are finer, in random ground.

#include "bounds/discharge_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <numbers>
#include <random>

#include "bounds/element_sizes.hpp"
#include "box_mesh.hpp"
#include "physics/head.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace discharge_bounds_test {

template <int Dim>
struct Ground {
  Mesh<Dim> mesh;
  std::vector<double> conductivity;             ///< per region, m/s
  std::vector<DirectionalFactor<Dim>> bedding;  ///< per region; may be empty
  std::vector<BoundaryCondition> boundaries;
  std::array<double, 3> gravity{};
};

/// The mesh with four triangles in the place of each.
Mesh<2> refined(const Mesh<2>& mesh) {
  Mesh<2> fine = mesh;
  fine.elements.clear();
  fine.element_region.clear();
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [at, is_new] =
        middles.emplace(std::minmax(a, b), static_cast<int>(fine.nodes.size()));
    if (is_new) fine.nodes.push_back(0.5 * (mesh.nodes[a] + mesh.nodes[b]));
    return at->second;
  };
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto [a, b, c] = mesh.elements[e];
    const int ab = middle(a, b);
    const int bc = middle(b, c);
    const int ca = middle(c, a);
    for (const auto& element : {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c},
                                std::array{ab, bc, ca}}) {
      fine.elements.push_back(element);
      fine.element_region.push_back(mesh.element_region[e]);
    }
  }
  for (BoundarySet<2>& set : fine.boundaries) {
    std::vector<std::array<int, 2>> halves;
    for (const auto& [a, b] : set.faces) {
      halves.push_back({a, middle(a, b)});
      halves.push_back({middle(a, b), b});
    }
    set.faces = halves;
  }
  return fine;
}

struct Found {
  DischargeBounds bounds;
  std::vector<double> discharge;  ///< of the mixed elements, per boundary
};

template <int Dim>
Found solve(const Ground<Dim>& ground) {
  Case<Dim> c;
  c.mesh = ground.mesh;
  Scene& scene = c.document.scene;
  scene = model::paper_scene();
  scene.gravity = ground.gravity;
  scene.boundaries = ground.boundaries;
  const Grid<Dim> grid(c.mesh);
  FlowCoefficients<Dim> coefficients = model::flow_coefficients<Dim>(grid, 1.0);
  FlowSoils<Dim> soils;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const int region = c.mesh.element_region[e];
    coefficients.drag[e] /= ground.conductivity[region];
    if (!ground.bedding.empty()) soils.bedding.push_back(ground.bedding[region]);
  }
  Vector<Dim> gravity;
  for (int d = 0; d < Dim; ++d) gravity[d] = ground.gravity[d];
  ImplicitMixed<Dim> scheme(grid, {}, gravity, soils);
  const std::vector<FaceCondition> conditions = face_conditions(c, grid);
  const MixedStep<Dim> flow = scheme.steady({coefficients, conditions, {}});
  Found found{discharge_bounds<Dim>({grid,
                                     scene,
                                     coefficients,
                                     conditions,
                                     scheme.soils(),
                                     scheme.walls(),
                                     flow.end.face_pressure,
                                     flow.face_flux,
                                     {}}),
              std::vector<double>(scene.boundaries.size(), 0.0)};
  for (int f = 0; f < grid.face_count(); ++f) {
    if (conditions[f].boundary >= 0) found.discharge[conditions[f].boundary] += flow.face_flux[f];
  }
  return found;
}

BoundaryCondition head_on(const std::string& name, double head) {
  BoundaryCondition b;
  b.on = name;
  b.head = head;
  return b;
}

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

template <int Dim>
DirectionalFactor<Dim> random_bedding(std::mt19937_64& random) {
  DirectionalFactor<Dim> factor;
  for (int d = 0; d < Dim; ++d) factor.direction[d] = uniform(random, -1.0, 1.0);
  factor.direction *= std::sqrt(uniform(random, 0.0, 0.99)) / factor.direction.norm();
  return factor;
}

/// Boundaries at two or three sides, of which one may have a flux.
template <int Dim>
void add_random_boundaries(std::mt19937_64& random, Ground<Dim>& ground) {
  // Above the square: no water level ends within a side.
  ground.boundaries = {head_on("left", uniform(random, 1.2, 3.0)), head_on("right", 1.1)};
  const double kind = uniform(random, 0.0, 3.0);
  if (kind < 1.0) {
    // Part of the top alone: heads must not differ where boundaries meet.
    ground.boundaries.push_back(head_on("middle", uniform(random, 1.1, 3.0)));
  } else if (kind < 2.0) {
    ground.boundaries.push_back(model::flux_on("bottom", uniform(random, -1e-4, 1e-4)));
  }
  if (uniform(random, 0.0, 1.0) < 0.5) ground.gravity[Dim - 1] = -9.81;
}

/// A square of 4 x 4 blocks of soils that differ up to a million times.
Ground<2> random_square(std::mt19937_64& random) {
  constexpr int blocks = 4;
  Ground<2> ground;
  ground.mesh = model::column_mesh(8, 8);
  const bool has_bedding = uniform(random, 0.0, 1.0) < 0.5;
  const double contrast = uniform(random, 0.0, 6.0);
  for (int block = 0; block < blocks * blocks; ++block) {
    ground.conductivity.push_back(std::pow(10.0, -4.0 - uniform(random, 0.0, contrast)));
    if (has_bedding) ground.bedding.push_back(random_bedding<2>(random));
  }
  ground.mesh.region_names.resize(ground.conductivity.size());
  for (int e = 0; e < ground.mesh.element_count(); ++e) {
    const Vector<2> x = blocks * element_centroid(ground.mesh, e);
    ground.mesh.element_region[e] = static_cast<int>(x[0]) + blocks * static_cast<int>(x[1]);
  }
  BoundarySet<2> middle{"middle", {}};
  for (const auto& face : ground.mesh.boundaries[0].faces) {
    const double x = 0.5 * (ground.mesh.nodes[face[0]][0] + ground.mesh.nodes[face[1]][0]);
    if (x > 0.25 && x < 0.75) middle.faces.push_back(face);
  }
  ground.mesh.boundaries.push_back(middle);
  add_random_boundaries(random, ground);
  return ground;
}

/// A cube of 2 x 2 x 2 such blocks, in cells of a number that is even.
Ground<3> random_cube(std::mt19937_64& random, int cells) {
  Ground<3> ground;
  ground.mesh = model::box_mesh({cells, cells, cells});
  for (int block = 0; block < 8; ++block) {
    ground.conductivity.push_back(std::pow(10.0, -4.0 - uniform(random, 0.0, 3.0)));
    ground.bedding.push_back(random_bedding<3>(random));
  }
  ground.mesh.region_names.resize(8);
  for (int e = 0; e < ground.mesh.element_count(); ++e) {
    const Vector<3> x = 2.0 * element_centroid(ground.mesh, e);
    ground.mesh.element_region[e] =
        static_cast<int>(x[0]) + 2 * static_cast<int>(x[1]) + 4 * static_cast<int>(x[2]);
  }
  ground.boundaries = {head_on("left", 2.0), head_on("right", 0.0)};
  if (uniform(random, 0.0, 1.0) < 0.5) {
    ground.boundaries.push_back(model::flux_on("bottom", uniform(random, -1e-4, 1e-4)));
  }
  return ground;
}

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

/// SECTIONS=200 in the environment for a study.
unsigned sections() {
  const char* asked = std::getenv("SECTIONS");
  return asked ? static_cast<unsigned>(std::atoi(asked)) : 12;
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
    const Interval& out = found.bounds.flux_out;
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
  const Interval scaled = solve(ground).bounds.flux_out;
  BoundarySet<2>& bottom = ground.mesh.boundaries[1];
  ground.mesh.boundaries.push_back({"rest", {bottom.faces.begin() + 4, bottom.faces.end()}});
  bottom.faces.resize(4);
  ground.boundaries.push_back(head_on("rest", 0.5));
  const Found found = solve(ground);
  EXPECT_NEAR(found.bounds.flux_out.low, scaled.low, 1e-3 * scaled.half());
  EXPECT_NEAR(found.bounds.flux_out.high, scaled.high, 1e-3 * scaled.half());
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
  EXPECT_NEAR(found.bounds.flux_out.low, 1e-3, 1e-9);
  EXPECT_NEAR(found.bounds.flux_out.high, 1e-3, 1e-9);
  EXPECT_GT(river.half(), 0.0);
  EXPECT_NEAR(found.bounds.least_known.half(), river.half(), 1e-6 * river.half())
      << "that of both together is known by balance";
}

/// Uniform flow is exact: nothing is left between the bounds.
TEST(DischargeBounds, OfAUniformFlowMeet) {
  Ground<2> ground;
  ground.mesh = model::column_mesh(5, 5, 1.0, 1.0, model::jittered(0.05, 3));
  ground.conductivity = {1e-4};
  ground.boundaries = {head_on("left", 2.0), head_on("right", 0.0)};
  const Interval q = solve(ground).bounds.flux_out;
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

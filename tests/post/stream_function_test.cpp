#include "values/stream_function.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/errors.hpp"
#include "mesh/slit.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace stream_function_test {

using testing::ScratchFolder;

/// The unit square in n x n cells of two triangles, with boundaries left and right.
Mesh<2> square(int n) {
  Mesh<2> mesh;
  const auto node = [&](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) mesh.nodes.emplace_back(double(i) / n, double(j) / n);
  }
  mesh.boundaries = {{"left", {}}, {"right", {}}};
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.elements.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1)});
      mesh.elements.push_back({node(i, j), node(i + 1, j + 1), node(i, j + 1)});
    }
    mesh.boundaries[0].faces.push_back({node(0, j + 1), node(0, j)});
    mesh.boundaries[1].faces.push_back({node(n, j), node(n, j + 1)});
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  mesh.region_names = {"soil"};
  return mesh;
}

/// Cuts the square along x = 1/2, from y = from / n to y = to / n.
void cut(Mesh<2>& mesh, int n, int from, int to) {
  BoundarySet<2> wall{"wall", {}};
  for (int j = from; j < to; ++j) {
    wall.faces.push_back({j * (n + 1) + n / 2, (j + 1) * (n + 1) + n / 2});
  }
  ASSERT_TRUE(slit(mesh, {wall}).empty());
}

std::vector<double> random_values(std::size_t count) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> values(count);
  for (double& value : values) value = uniform(generator);
  return values;
}

/// The flux whose stream function is a psi that is linear between nodes: q = (psi_y, -psi_x).
std::vector<double> flux_of(const Mesh<2>& mesh, const std::vector<double>& psi) {
  std::vector<double> flux;
  for (int e = 0; e < mesh.element_count(); ++e) {
    Vector<2> q = Vector<2>::Zero();
    for (int a = 0; a < 3; ++a) {
      const Vector<2> edge =
          mesh.nodes[mesh.elements[e][(a + 2) % 3]] - mesh.nodes[mesh.elements[e][(a + 1) % 3]];
      q += psi[mesh.elements[e][a]] * edge / (2.0 * element_volume(mesh, e));
    }
    flux.insert(flux.end(), {q[0], q[1]});
  }
  return flux;
}

std::vector<double> uniform_flux(const Mesh<2>& mesh, double x, double y) {
  std::vector<double> flux;
  for (int e = 0; e < mesh.element_count(); ++e) flux.insert(flux.end(), {x, y});
  return flux;
}

TEST(StreamFunction, OfAUniformFluxGrowsToItsLeft) {
  const Mesh<2> mesh = square(6);
  const StreamFunction stream = stream_function({mesh, uniform_flux(mesh, 3.0, -2.0), {}});
  for (int i = 0; i < mesh.node_count(); ++i) {
    const Vector<2>& x = mesh.nodes[i];
    EXPECT_NEAR(stream.at_nodes[i], 3.0 * x[1] + 2.0 * x[0], 1e-14);
  }
  EXPECT_NEAR(stream.discharge, 5.0, 1e-14);
  EXPECT_LT(stream.misfit, 1e-15);
}

TEST(StreamFunction, OfAnyFluxWithoutSourcesIsExact) {
  const Mesh<2> mesh = square(20);
  std::vector<double> psi = random_values(mesh.nodes.size());
  const StreamFunction stream = stream_function({mesh, flux_of(mesh, psi), {}});
  const double least = std::ranges::min(psi);
  for (std::size_t i = 0; i < psi.size(); ++i) {
    EXPECT_NEAR(stream.at_nodes[i], psi[i] - least, 1e-12);
  }
  EXPECT_LT(stream.misfit, 1e-13);
}

TEST(StreamFunction, OfAFluxWithSourcesIsThatOfLeastSquares) {
  const Mesh<2> mesh = square(8);
  const std::vector<double> flux = random_values(2 * mesh.elements.size());
  const StreamFunction stream = stream_function({mesh, flux, {}});
  const auto missed = [&](const std::vector<double>& psi) {
    const std::vector<double> found = flux_of(mesh, psi);
    double all = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < flux.size(); ++i) {
      sum += (found[i] - flux[i]) * (found[i] - flux[i]);
      all += flux[i] * flux[i];
    }
    return std::sqrt(sum / all);
  };
  EXPECT_GT(stream.misfit, 0.1);
  EXPECT_NEAR(missed(stream.at_nodes), stream.misfit, 1e-12);
  for (std::size_t i = 0; i < stream.at_nodes.size(); ++i) {
    for (const double change : {-1e-3, 1e-3}) {
      std::vector<double> other = stream.at_nodes;
      other[i] += change;
      EXPECT_GT(missed(other), stream.misfit);
    }
  }
}

TEST(StreamFunction, IsOneNumberAlongAWall) {
  constexpr int n = 8;
  Mesh<2> mesh = square(n);
  cut(mesh, n, 2, 6);
  // Upright flow past the wall.
  const ElementFlow flow{mesh, uniform_flux(mesh, 0.0, 1.0), {}};
  EXPECT_TRUE(inner_sources(flow).empty());
  const StreamFunction stream = stream_function(flow);
  for (const auto& face : mesh.boundaries.back().faces) {
    EXPECT_NEAR(stream.at_nodes[face[0]], 0.5, 1e-14);
  }
}

TEST(StreamFunction, GoesOnBehindAWallThatLetsLiquidThrough) {
  constexpr int n = 8;
  Mesh<2> mesh = square(n);
  cut(mesh, n, 0, n);
  const auto flux = uniform_flux(mesh, 2.0, 0.0);
  for (const bool leaky : {true, false}) {
    const ElementFlow flow{mesh, flux,
                           leaky ? std::vector<std::string>{"wall"} : std::vector<std::string>{}};
    EXPECT_TRUE(inner_sources(flow).empty());
    const StreamFunction stream = stream_function(flow);
    for (int i = 0; i < mesh.node_count(); ++i) {
      EXPECT_NEAR(stream.at_nodes[i], 2.0 * mesh.nodes[i][1], 1e-13);
    }
    // Without the wall's name its two sides are two outer edges.
    EXPECT_NEAR(stream.discharge, leaky ? 2.0 : 4.0, 1e-13);
  }
}

TEST(StreamFunction, HasNoSingleValueAroundAWell) {
  constexpr int n = 8;
  Mesh<2> mesh = square(n);
  cut(mesh, n, 3, 5);
  std::vector<double> flux;
  for (int e = 0; e < mesh.element_count(); ++e) {
    flux.insert(flux.end(), {element_centroid(mesh, e)[0] < 0.5 ? 1.0 : -1.0, 0.0});
  }
  const auto sources = inner_sources({mesh, flux, {}});
  ASSERT_EQ(sources.size(), 1U);
  EXPECT_EQ(sources[0].boundary, "wall");
  EXPECT_NEAR(sources[0].discharge, -2.0 * 0.25, 1e-14);
}

/// A run of one snapshot with this flux everywhere, m/s; the conductivity is 2e-2 m/s.
ResultsReader run_with(const ScratchFolder& scratch, double flux) {
  const Case<2> c = testing::unit_square_case();
  {
    ResultsWriter<2> writer(scratch / "run.results", c);
    Snapshot s = testing::linear_snapshot(c, 0.0, 0);
    for (std::size_t i = 0; i < s.cell[2].values.size(); ++i) {
      s.cell[2].values[i] = i % 2 == 0 ? 0.0 : flux;
    }
    writer.write_snapshot(s);
  }
  return ResultsReader(scratch / "run.results");
}

TEST(StreamFunction, OfARunIsThatOfItsFlux) {
  const ScratchFolder scratch;
  const ResultsReader run = run_with(scratch, -1e-3);
  EXPECT_TRUE(flows(run, 0));
  const Mesh<2> mesh = run.mesh();
  const StreamFunction stream = stream_function(run, 0, mesh, "test");
  EXPECT_NEAR(stream.discharge, 1e-3, 1e-17);
  EXPECT_NEAR(stream.at_nodes[2], 1e-3, 1e-17);
}

TEST(StreamFunction, IsRefusedOfLiquidAtRest) {
  const ScratchFolder scratch;
  const ResultsReader run = run_with(scratch, 1e-13);
  EXPECT_FALSE(flows(run, 0));
  try {
    stream_function(run, 0, run.mesh(), "test");
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "test: RESULTS: got " + run.folder() +
                  ", where the liquid is at rest; expected a flow, which has streamlines");
  }
}

}  // namespace stream_function_test
}  // namespace suffuse

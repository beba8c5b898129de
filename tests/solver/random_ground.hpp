#pragma once

/// Steady flow through random ground, with the bounds and estimates of what it discharges.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <random>

#include "bounds/discharge_bounds.hpp"
#include "box_mesh.hpp"
#include "physics/head.hpp"
#include "solver/model_case.hpp"

namespace suffuse::random_ground {

template <int Dim>
struct Ground {
  Mesh<Dim> mesh;
  std::vector<double> conductivity;             ///< per region, m/s
  std::vector<DirectionalFactor<Dim>> bedding;  ///< per region; may be empty
  std::vector<BoundaryCondition> boundaries;
  std::array<double, 3> gravity{};
  std::vector<OutputProbe> probes = {};
};

/// The mesh with four triangles in the place of each.
inline Mesh<2> refined(const Mesh<2>& mesh) {
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
Found solve(const Ground<Dim>& ground, const LastStepErrors& step = {}) {
  Case<Dim> c;
  c.mesh = ground.mesh;
  Scene& scene = c.document.scene;
  scene = model::paper_scene();
  scene.gravity = ground.gravity;
  scene.boundaries = ground.boundaries;
  scene.output.probes = ground.probes;
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
                                     {},
                                     1,
                                     step}),
              std::vector<double>(scene.boundaries.size(), 0.0)};
  for (int f = 0; f < grid.face_count(); ++f) {
    if (conditions[f].boundary >= 0) found.discharge[conditions[f].boundary] += flow.face_flux[f];
  }
  return found;
}

inline BoundaryCondition head_on(const std::string& name, double head) {
  BoundaryCondition b;
  b.on = name;
  b.head = head;
  return b;
}

inline double uniform(std::mt19937_64& random, double low, double high) {
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
inline Ground<2> random_square(std::mt19937_64& random) {
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
inline Ground<3> random_cube(std::mt19937_64& random, int cells) {
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

/// SECTIONS=200 in the environment for a study.
inline unsigned sections() {
  const char* asked = std::getenv("SECTIONS");
  return asked ? static_cast<unsigned>(std::atoi(asked)) : 12;
}

}  // namespace suffuse::random_ground

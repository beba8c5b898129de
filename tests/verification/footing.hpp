#pragma once

/// Limit loads of strip footings on weightless soil, by displacements of a rough rigid footing in
/// stiff soil, which keeps its shape.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "solver/solid_model.hpp"
#include "verification/free_mesh.hpp"

namespace suffuse::footing {

using model::PlaneModel;

enum class Triangles { crossed, in_rows, free };

/// Half of a footing of width 2, at the left of the top of a box that contains the whole mechanism.
struct Footing {
  const char* law = "mohr-coulomb";
  double friction = 0.0;  ///< degrees; flow is associated
  double cohesion = 0.0;
  double surcharge = 0.0;  ///< next to the footing, and in the soil all around at the start
  Triangles triangles = Triangles::crossed;
  int steps = 6;
  double push = 80.0;  ///< final displacement, over the unit of stress over E
};

/// tan^2(45 + phi/2) exp(pi tan phi)
inline double exact_surcharge_factor(double friction) {
  const double phi = friction * std::numbers::pi / 180.0;
  return std::pow(std::tan(0.25 * std::numbers::pi + 0.5 * phi), 2) *
         std::exp(std::numbers::pi * std::tan(phi));
}

inline double exact_cohesion_factor(double friction) {
  if (friction == 0.0) return 2.0 + std::numbers::pi;
  return (exact_surcharge_factor(friction) - 1.0) / std::tan(friction * std::numbers::pi / 180.0);
}

/// End of the mechanism next to the footing, from its middle; its depth is a third of that.
inline double mechanism(double friction) {
  const double phi = friction * std::numbers::pi / 180.0;
  return 1.0 + 2.0 * std::tan(0.25 * std::numbers::pi + 0.5 * phi) *
                   std::exp(0.5 * std::numbers::pi * std::tan(phi));
}

/// Soil and footing, with `cells` under half of the footing.
struct FootingModel : PlaneModel {
  FootingModel(const Footing& footing, int cells)
      : PlaneModel(mesh_of(footing, cells), 1, soil_of(footing)) {
    support("left", Support::normal);
    support("right", Support::normal);
    support("bottom", Support::both);
    limits = {.max_iterations = 40, .tolerance = 1e-7};
    for (SkeletonState& state : points.skeleton) {
      state.elastic_b =
          elastic_b_under(skeleton[0].parameters, -footing.surcharge * Eigen::Matrix3d::Identity());
    }
    const double edge = 1.0 + 0.1 / cells;
    for (const int f : faces_of("top")) {
      const bool below = grid.face_centre(f)[0] < edge;
      if (!below) beside.push_back(f);
      for (const int i : grid.face_nodes[f]) {
        if (below && std::ranges::find(held, i) == held.end()) held.push_back(i);
      }
    }
  }

  static Mesh<2> mesh_of(const Footing& footing, int cells) {
    const int nx = static_cast<int>(std::ceil(cells * 1.1 * mechanism(footing.friction)));
    const int ny = static_cast<int>(std::ceil(nx / 1.8));
    const double width = static_cast<double>(nx) / cells;
    const double height = static_cast<double>(ny) / cells;
    if (footing.triangles == Triangles::free) return model::free_mesh(1.0 / cells, width, height);
    return footing.triangles == Triangles::crossed ? model::crossed_mesh(nx, ny, width, height)
                                                   : model::column_mesh(nx, ny, width, height);
  }
  static SkeletonModel soil_of(const Footing& footing) {
    SkeletonModel soil;
    soil.law = skeleton_law(footing.law);
    soil.young = young;
    soil.poisson = 0.3;
    soil.friction = footing.friction;
    soil.dilation = footing.friction;
    soil.cohesion = footing.cohesion;
    return soil;
  }

  static constexpr double young = 1e6;
  std::vector<int> held;    ///< nodes under the footing
  std::vector<int> beside;  ///< faces that carry the surcharge
};

/// The final mean pressure under the footing: all forces at its nodes over its own width. Throws
/// NumericalError if Newton's method does not converge.
inline double limit_load(const Footing& footing, int cells) {
  FootingModel m(footing, cells);
  NodalLoads<2> surcharge(m.grid);
  LoadedSurface<2>(m.grid, m.sorted, m.beside)
      .add_traction(m.grid, m.sorted, Vector<2>(0.0, -footing.surcharge), surcharge);
  const NodeVectors<2>& loads = surcharge.forces();
  NodeVectors<2> down = m.no_loads();
  const double unit = std::max(footing.cohesion, footing.surcharge);
  for (const int i : m.held) {
    down[i][1] = -footing.push * unit / FootingModel::young / footing.steps;
  }
  Footing without_limit = footing;
  without_limit.law = "elastic";
  FootingModel elastic(without_limit, cells);
  down = elastic.step(loads, down, elastic.held).displacement;  // a start near the first step
  int iterations = 0;
  for (int step = 0; step < footing.steps; ++step) {
    const NewtonSolution<2> solution = m.step(loads, down, m.held);
    if (!solution.converged) throw NumericalError("Newton's method did not converge");
    iterations += solution.iterations();
    down = solution.displacement;  // a start near the next one
  }
  const Supports<2> supports(m.grid, m.face_support);
  Equilibrium<2> equilibrium(m.body(), supports, 1);
  equilibrium.displace(m.no_loads(), false);
  const NodeVectors<2> forces = equilibrium.forces();
  double load = 0.0;
  for (const int i : m.held) load += loads[i][1] - forces[i][1];
  constexpr std::array<const char*, 3> names{", crossed, ", ", in rows, ", ", free, "};
  std::cout << footing.law << names[static_cast<int>(footing.triangles)] << footing.friction
            << " degrees, " << cells << " cells, " << m.mesh.element_count()
            << " elements: " << load << ", iterations a step "
            << static_cast<double>(iterations) / footing.steps << std::endl;
  return load;
}

/// Limit of the loads for fine meshes, from those of 2 and 4 cells: the edge of the footing makes
/// their errors proportional to the size of cells. Both are above `exact`, as flow is associated
/// and the displacements are kinematically admissible.
inline double limit_of_fine_meshes(const Footing& footing, double exact) {
  const double coarse = limit_load(footing, 2);
  const double fine = limit_load(footing, 4);
  if (!(coarse > fine && fine > exact)) throw NumericalError("the loads are no upper bounds");
  std::cout << "limit " << 2.0 * fine - coarse << ", exact " << exact << std::endl;
  return 2.0 * fine - coarse;
}

}  // namespace suffuse::footing

#pragma once

/// Small bodies of soil on material points that move through a mesh, for tests: no files, no flow.

#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>

#include "deformation/loads.hpp"
#include "deformation/newton.hpp"
#include "deformation/point_motion.hpp"
#include "seeding.hpp"
#include "solver/model_case.hpp"

namespace suffuse::model {

/// [0, width] x [0, height] in nx x ny cells of four triangles that meet in the middle.
inline Mesh<2> crossed_mesh(int nx, int ny, double width, double height) {
  Mesh<2> mesh = column_mesh(nx, ny, width, height);
  mesh.elements.clear();
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int a = j * (nx + 1) + i;
      const std::array<int, 4> corners{a, a + 1, a + nx + 2, a + nx + 1};
      const int middle = mesh.node_count();
      mesh.nodes.push_back(0.5 * (mesh.nodes[corners[0]] + mesh.nodes[corners[2]]));
      for (int k = 0; k < 4; ++k) {
        mesh.elements.push_back({corners[k], corners[(k + 1) % 4], middle});
      }
    }
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  return mesh;
}

/// Places that share a triangle's volume: a quadrature rule, or with 4 the centroids of the four
/// triangles that the midpoints of the sides make.
inline std::vector<QuadraturePoint<2>> places_in_triangle(int count) {
  if (count != 4) return triangle_rule(count);
  std::vector<QuadraturePoint<2>> places{{{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}, 0.25}};
  for (int k = 0; k < 3; ++k) {
    places.push_back({{1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0}, 0.25});
    places.back().barycentric[k] = 2.0 / 3.0;
  }
  return places;
}

/// Soil in the elements whose centroid `holds` names, and what a step does to it.
class SolidModel {
 public:
  SolidModel(
      Mesh<2> mesh_in, int points_per_element, const SkeletonModel& soil,
      const std::function<bool(const Vector<2>&)>& holds = [](const Vector<2>&) { return true; })
      : mesh(std::move(mesh_in)), grid(mesh), face_support(grid.face_count(), Support::none) {
    std::vector<PointPlace<2>> places;
    std::vector<double> volume;
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (!holds(element_centroid(mesh, e))) continue;
      for (const QuadraturePoint<2>& at : places_in_triangle(points_per_element)) {
        places.push_back({e, at.barycentric});
        volume.push_back(at.weight * grid.volume[e]);
      }
    }
    points = SolidPoints<2>(mesh, places, volume);
    start = points.position;
    skeleton.assign(points.size(), {soil.law, soil.at(1.0)});
    sort();
  }

  SolidModel(const SolidModel&) = delete;  // the grid refers to the mesh
  SolidModel& operator=(const SolidModel&) = delete;

  /// Holds the soil at a boundary of the mesh.
  void support(const std::string& boundary, Support how) {
    for (const int f : faces_of(boundary)) face_support[f] = how;
  }
  [[nodiscard]] std::vector<int> faces_of(const std::string& boundary) const {
    std::vector<int> faces;
    for (const BoundarySet<2>& set : mesh.boundaries) {
      if (set.name != boundary) continue;
      for (const auto& nodes : set.faces) faces.push_back(grid.find_face(nodes));
    }
    if (faces.empty()) throw std::invalid_argument("no boundary " + boundary);
    return faces;
  }
  /// Faces between soil and elements without soil, or at the border, whose centre lies at y.
  [[nodiscard]] std::vector<int> faces_at_height(double y) const {
    std::vector<int> faces;
    for (int f = 0; f < grid.face_count(); ++f) {
      const bool level = std::abs(grid.face_normal[f][0]) < 1e-9 * grid.face_normal[f].norm();
      if (level && std::abs(grid.face_centre(f)[1] - y) < 1e-9) faces.push_back(f);
    }
    return faces;
  }

  [[nodiscard]] NodeVectors<2> no_loads() const {
    return NodeVectors<2>(mesh.node_count(), Vector<2>::Zero());
  }
  /// Weight of `weight`, N per m3 of what the points held at the start.
  [[nodiscard]] NodeVectors<2> weight(double weight) const {
    std::vector<Vector<2>> force;
    for (const double v : points.reference_volume) force.emplace_back(0.0, -weight * v);
    NodeVectors<2> loads = no_loads();
    add_point_forces(grid, points, force, loads);
    return loads;
  }

  [[nodiscard]] SolidBody<2> body() const { return {grid, points, sorted, skeleton, *classes}; }

  /// A step under these loads at its end; the points move where it converges.
  NewtonSolution<2> step(const NodeVectors<2>& loads, const NodeVectors<2>& prescribed = {},
                         const std::vector<int>& held = {}) {
    Supports<2> supports(grid, face_support);
    for (const int i : held) supports.hold(i);
    Equilibrium<2> equilibrium(body(), supports, threads);
    NewtonSolution<2> solution = solve_equilibrium(equilibrium, loads, prescribed, limits);
    if (!solution.converged) return solution;
    surface.move(grid, sorted, solution.displacement);
    move_points(grid, skeleton, solution.displacement, points, threads);
    sort();
    return solution;
  }

  void sort() {
    sorted = PointsByElement(mesh.element_count(), points.element);
    classes = std::make_unique<ElementClasses>(grid, points, sorted);
  }

  /// sigma of a point, Pa.
  [[nodiscard]] Eigen::Matrix3d stress(int p) const {
    const auto response = skeleton_response<2>(*skeleton[p].law, skeleton[p].parameters,
                                               points.elastic_b[p], Eigen::Matrix2d::Identity());
    return response.stress * points.reference_volume[p] / points.volume[p];
  }
  [[nodiscard]] double soil_volume() const {
    double sum = 0.0;
    for (const double v : points.volume) sum += v;
    return sum;
  }

  Mesh<2> mesh;
  Grid<2> grid;
  std::vector<Support> face_support;
  SolidPoints<2> points;
  std::vector<Vector<2>> start;  ///< places of the points at the start
  std::vector<PointSkeleton> skeleton;
  PointsByElement sorted;
  std::unique_ptr<ElementClasses> classes;
  LoadedSurface<2> surface;
  NewtonLimits limits;
  int threads = 1;
};

inline SkeletonModel elastic_soil(double young, double poisson) {
  SkeletonModel soil;
  soil.law = skeleton_law("elastic");
  soil.young = young;
  soil.poisson = poisson;
  return soil;
}

}  // namespace suffuse::model

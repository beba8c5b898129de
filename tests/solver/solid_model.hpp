#pragma once

/// Small bodies of soil on material points that move through a mesh, for tests without files and
/// flow.

#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>

#include "boundary/loads.hpp"
#include "equilibrium/newton.hpp"
#include "grid/element_field.hpp"
#include "motion/point_motion.hpp"
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
      mesh.nodes.emplace_back(0.5 * (mesh.nodes[corners[0]] + mesh.nodes[corners[2]]));
      for (int k = 0; k < 4; ++k) {
        const std::array<int, 3> element{corners[k], corners[(k + 1) % 4], middle};
        mesh.elements.push_back(element);
      }
    }
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  return mesh;
}

/// Points that share a triangle's volume: those of a quadrature rule, or with 4 the centroids of
/// the four triangles made by the midpoints of the sides.
inline std::vector<QuadraturePoint<2>> places_in_triangle(int count) {
  if (count != 4) return gauss_rule<2>(count);
  std::vector<QuadraturePoint<2>> places{{{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}, 0.25}};
  for (int k = 0; k < 3; ++k) {
    places.push_back({{1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0}, 0.25});
    places.back().barycentric[k] = 2.0 / 3.0;
  }
  return places;
}

/// The four Gauss points of a tetrahedron.
inline std::vector<QuadraturePoint<3>> places_in_tetrahedron() {
  std::vector<QuadraturePoint<3>> places(4);
  for (int k = 0; k < 4; ++k) {
    places[k].weight = 0.25;
    places[k].barycentric.fill(FieldNodes<3>::far_vertex);
    places[k].barycentric[k] = FieldNodes<3>::near_vertex;
  }
  return places;
}

/// Soil in the elements whose centroid fulfils `holds`, and a step of it.
template <int Dim>
class SolidModel {
 public:
  SolidModel(
      Mesh<Dim> mesh_in, const std::vector<QuadraturePoint<Dim>>& places_in_element,
      const SkeletonModel& soil,
      const std::function<bool(const Vector<Dim>&)>& holds =
          [](const Vector<Dim>&) { return true; })
      : mesh(std::move(mesh_in)), grid(mesh), face_support(grid.face_count(), Support::none) {
    std::vector<PointPlace<Dim>> places;
    std::vector<double> volume;
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (!holds(element_centroid(mesh, e))) continue;
      for (const QuadraturePoint<Dim>& at : places_in_element) {
        places.push_back({e, at.barycentric});
        volume.push_back(at.weight * grid.volume[e]);
      }
    }
    points = SolidPoints<Dim>(mesh, places, volume);
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
    for (const BoundarySet<Dim>& set : mesh.boundaries) {
      if (set.name != boundary) continue;
      for (const auto& nodes : set.faces) faces.push_back(grid.find_face(nodes));
    }
    if (faces.empty()) throw std::invalid_argument("no boundary " + boundary);
    return faces;
  }
  [[nodiscard]] NodeVectors<Dim> no_loads() const {
    return NodeVectors<Dim>(mesh.node_count(), Vector<Dim>::Zero());
  }
  /// No loads, on quadratic displacements.
  [[nodiscard]] NodalLoads<Dim> no_quadratic_loads() const {
    return {grid, std::make_shared<QuadraticShapes<Dim>>(grid)};
  }
  /// Weight, N per m3 of the soil's volume at the start, along the last axis.
  [[nodiscard]] NodeVectors<Dim> weight(double weight) const {
    return weight_on(NodalLoads<Dim>(grid), weight).forces();
  }
  [[nodiscard]] NodalLoads<Dim> quadratic_weight(double weight) const {
    return weight_on(no_quadratic_loads(), weight);
  }

  [[nodiscard]] SolidBody<Dim> body() const { return {grid, points, sorted, skeleton, *classes}; }

  /// Makes a step under these loads at its end; the points move if it converges.
  /// \param from  possible displacement, which held directions keep, m; empty: none
  NewtonSolution<Dim> step(const NodeVectors<Dim>& loads, const NodeVectors<Dim>& from = {},
                           const std::vector<int>& held = {}) {
    Supports<Dim> supports(grid, face_support);
    for (const int i : held) supports.hold(i);
    Equilibrium<Dim> equilibrium(body(), supports, threads);
    NewtonSolution<Dim> solution =
        EquilibriumSolver<Dim>(equilibrium).solve(loads, from.empty() ? no_loads() : from, limits);
    if (!solution.converged) return solution;
    surface.move(grid, sorted, solution.displacement);
    move_points(grid, skeleton, solution.displacement,
                equilibrium.law_increments(solution.displacement), points, threads);
    sort();
    return solution;
  }

  [[nodiscard]] NodalLoads<Dim> weight_on(NodalLoads<Dim> loads, double weight) const {
    std::vector<Vector<Dim>> force;
    for (const double v : points.reference_volume)
      force.emplace_back(-weight * v * Vector<Dim>::Unit(Dim - 1));
    add_point_forces(grid, points, force, loads);
    return loads;
  }

  void sort() {
    sorted = PointsByElement(mesh.element_count(), points.element);
    classes = std::make_unique<ElementClasses>(grid, points, sorted);
  }

  /// sigma of a point, Pa.
  [[nodiscard]] Eigen::Matrix3d stress(int p) const {
    const auto response =
        skeleton_response<Dim>(*skeleton[p].law, skeleton[p].parameters, points.skeleton[p],
                               Eigen::Matrix<double, Dim, Dim>::Identity());
    return response.stress * points.reference_volume[p] / points.volume[p];
  }
  [[nodiscard]] double soil_volume() const {
    double sum = 0.0;
    for (const double v : points.volume) sum += v;
    return sum;
  }

  Mesh<Dim> mesh;
  Grid<Dim> grid;
  std::vector<Support> face_support;
  SolidPoints<Dim> points;
  std::vector<Vector<Dim>> start;  ///< places of the points at the start
  std::vector<PointSkeleton> skeleton;
  PointsByElement sorted;
  std::unique_ptr<ElementClasses> classes;
  LoadedSurface<Dim> surface;
  NewtonLimits limits;
  int threads = 1;
};

/// Triangles with the points of `places_in_triangle`.
struct PlaneModel : SolidModel<2> {
  PlaneModel(
      Mesh<2> mesh_in, int points_per_element, const SkeletonModel& soil,
      const std::function<bool(const Vector<2>&)>& holds = [](const Vector<2>&) { return true; })
      : SolidModel<2>(std::move(mesh_in), places_in_triangle(points_per_element), soil, holds) {}
};

inline SkeletonModel elastic_soil(double young, double poisson) {
  SkeletonModel soil;
  soil.law = skeleton_law("elastic");
  soil.young = young;
  soil.poisson = poisson;
  return soil;
}

}  // namespace suffuse::model

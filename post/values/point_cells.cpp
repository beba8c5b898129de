#include "values/point_cells.hpp"

#include <vtkCellArray.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>
#include <vtkStaticPointLocator.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drawing/contours.hpp"

namespace suffuse {
namespace {

using Polygon = std::vector<Vector<2>>;
/// The points of each element or at each node.
using PointLists = std::vector<std::vector<std::size_t>>;
/// Share of its area from which an element is full, share around each node from which one without
/// points is a hole in the soil, and share around a node at a surface.
constexpr double full = 0.9;
constexpr double full_around = 0.65;
constexpr double at_surface = 0.5;
constexpr int disc_corners = 24;

/// The part of a convex polygon in which normal . x is at most `most`.
Polygon clipped(const Polygon& polygon, const Vector<2>& normal, double most) {
  Polygon part;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector<2>& a = polygon[k];
    const Vector<2>& b = polygon[(k + 1) % polygon.size()];
    const double over_a = normal.dot(a) - most;
    const double over_b = normal.dot(b) - most;
    if (over_a <= 0.0) part.push_back(a);
    if ((over_a < 0.0) != (over_b < 0.0) && over_a != over_b) {
      part.push_back(a + over_a / (over_a - over_b) * (b - a));
    }
  }
  return part;
}

/// The part of a polygon that is nearer to `x` than to `other`.
Polygon nearer(const Polygon& polygon, const Vector<2>& x, const Vector<2>& other) {
  const Vector<2> way = other - x;
  return clipped(polygon, way, way.dot(0.5 * (x + other)));
}

/// A surface of VTK for its locators: the mesh, or points alone.
vtkSmartPointer<vtkPolyData> surface_of(const std::vector<Vector<2>>& places,
                                        const std::vector<std::array<int, 3>>& triangles) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vector<2>& x : places) points->InsertNextPoint(x[0], x[1], 0.0);
  vtkNew<vtkCellArray> cells;
  for (const auto& nodes : triangles) {
    cells->InsertNextCell({nodes[0], nodes[1], nodes[2]});
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(cells);
  return surface;
}

/// The points in each element.
PointLists points_in_elements(const Mesh<2>& mesh, const std::vector<Vector<2>>& positions) {
  const vtkSmartPointer<vtkPolyData> surface = surface_of(mesh.nodes, mesh.elements);
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(surface);
  locator->BuildLocator();
  const double tolerance = std::pow(1e-9 * largest_coordinate(mesh), 2);
  vtkNew<vtkGenericCell> cell;
  PointLists points(mesh.elements.size());
  for (std::size_t p = 0; p < positions.size(); ++p) {
    double x[3] = {positions[p][0], positions[p][1], 0.0};
    double local[3];
    double weights[3];
    const vtkIdType e = locator->FindCell(x, tolerance, cell, local, weights);
    if (e >= 0) points[static_cast<std::size_t>(e)].push_back(p);
  }
  return points;
}

/// How much of the model is full of points, as shares of area or volume.
struct Fill {
  std::vector<double> elements;
  std::vector<double> nodes;  ///< over the elements around
};

Fill fill_of(const Mesh<2>& mesh, const PointLists& points, const std::vector<double>& volumes) {
  Fill fill{std::vector<double>(mesh.elements.size(), 0.0),
            std::vector<double>(mesh.nodes.size(), 0.0)};
  std::vector<double> around(mesh.nodes.size(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double area = element_volume(mesh, e);
    double volume = 0.0;
    for (const std::size_t p : points[e]) volume += volumes[p];
    fill.elements[e] = volume / area;
    for (const int node : mesh.elements[e]) {
      fill.nodes[node] += volume;
      around[node] += area;
    }
  }
  for (std::size_t i = 0; i < around.size(); ++i) fill.nodes[i] /= around[i];
  return fill;
}

/// The part of an element that is drawn full.
Polygon full_part(const Mesh<2>& mesh, int element, const Fill& fill, bool has_points) {
  std::array<Vector<2>, 3> corners;
  std::array<double, 3> shares{};
  for (int a = 0; a < 3; ++a) {
    corners.at(a) = mesh.nodes[mesh.elements[element][a]];
    shares.at(a) = fill.nodes[mesh.elements[element][a]];
  }
  const bool whole =
      has_points ? fill.elements[element] >= full : std::ranges::min(shares) >= full_around;
  if (whole) return {corners.begin(), corners.end()};
  return has_points ? band_in_triangle(corners, shares, at_surface, HUGE_VAL) : Polygon{};
}

/// A disc of the volume of a point, without what is nearer to others.
Polygon disc(const std::vector<Vector<2>>& positions, std::size_t point, double volume,
             vtkStaticPointLocator& locator) {
  const double radius = std::sqrt(std::max(volume, 0.0) / std::numbers::pi);
  const Vector<2>& x = positions[point];
  Polygon polygon;
  polygon.reserve(disc_corners);
  for (int k = 0; k < disc_corners; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / disc_corners;
    polygon.push_back(x + radius * Vector<2>(std::cos(angle), std::sin(angle)));
  }
  vtkNew<vtkIdList> around;
  const double at[3] = {x[0], x[1], 0.0};
  locator.FindPointsWithinRadius(2.0 * radius, at, around);
  for (vtkIdType k = 0; k < around->GetNumberOfIds(); ++k) {
    const Vector<2>& other = positions[static_cast<std::size_t>(around->GetId(k))];
    if (other != x) polygon = nearer(polygon, x, other);
  }
  return polygon;
}

/// Divides a polygon among the points nearest to it. The first point gets all of it beneath the
/// others, so that no seams are seen between them.
void divide(const Polygon& polygon, const std::vector<Vector<2>>& positions,
            const std::vector<std::size_t>& points, std::vector<PointCell>& cells) {
  for (const std::size_t p : points) {
    Polygon part = polygon;
    if (p == points.front()) {
      cells.push_back({p, polygon});
      continue;
    }
    for (const std::size_t other : points) {
      if (positions[other] != positions[p]) part = nearer(part, positions[p], positions[other]);
    }
    if (part.size() > 2) cells.push_back({p, std::move(part)});
  }
}

std::vector<PointCell> cells_of_points_at_rest(const Mesh<2>& mesh, const PointLists& points,
                                               const std::vector<Vector<2>>& positions) {
  std::vector<PointCell> cells;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto& [a, b, c] = mesh.elements[e];
    divide({mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]}, positions, points[e], cells);
  }
  return cells;
}

/// The points in the elements that share a node with this one.
std::vector<std::size_t> points_around(const Mesh<2>& mesh, int element,
                                       const PointLists& at_nodes) {
  std::vector<std::size_t> found;
  for (const int node : mesh.elements[element]) {
    found.insert(found.end(), at_nodes[node].begin(), at_nodes[node].end());
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace

std::vector<PointCell> point_cells(const Mesh<2>& mesh, const std::vector<Vector<2>>& positions,
                                   const std::vector<double>& volumes) {
  if (positions.empty()) return {};
  const PointLists points = points_in_elements(mesh, positions);
  if (volumes.empty()) return cells_of_points_at_rest(mesh, points, positions);
  const Fill fill = fill_of(mesh, points, volumes);
  const vtkSmartPointer<vtkPolyData> cloud = surface_of(positions, {});
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(cloud);
  locator->BuildLocator();
  PointLists at_nodes(mesh.nodes.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (const int node : mesh.elements[e]) {
      at_nodes[node].insert(at_nodes[node].end(), points[e].begin(), points[e].end());
    }
  }
  std::vector<PointCell> cells;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (fill.elements[e] >= full) continue;
    for (const std::size_t p : points[e]) {
      cells.push_back({p, disc(positions, p, volumes[p], *locator)});
    }
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Polygon part = full_part(mesh, e, fill, !points[e].empty());
    if (part.empty()) continue;
    divide(part, positions, points[e].empty() ? points_around(mesh, e, at_nodes) : points[e],
           cells);
  }
  return cells;
}

}  // namespace suffuse

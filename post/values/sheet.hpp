#pragma once

/// Triangles in a mesh of tetrahedra: its surface, a cut by a plane, a surface of equal values.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

/// A place on an edge of a mesh, or at a node, which is then given twice.
struct EdgePlace {
  std::array<int, 2> nodes;
  double share = 0.0;  ///< share of the way from the first node to the second
};

/// Triangles, each within one tetrahedron or on its side. Neighbours share nodes.
struct Sheet {
  std::vector<EdgePlace> nodes;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> element;  ///< the tetrahedron of each triangle
};

Vector<3> position(const Mesh<3>& mesh, const EdgePlace& place);

/// The outer faces; their nodes are in counterclockwise order as seen from outside.
Sheet outer_sheet(const Mesh<3>& mesh);

/// The surface on which a field that is linear between the nodes has the value `level`. Elements
/// with a value that is not finite are left out.
Sheet level_sheet(const Mesh<3>& mesh, const std::vector<double>& at_nodes, double level);

/// Values of a field of "cell", "node" or "element_vertex" on a sheet: one per triangle, per node,
/// or three per triangle.
std::vector<double> sheet_values(const Mesh<3>& mesh, const Sheet& sheet, const std::string& where,
                                 const std::vector<double>& values);

/// Values of such a field at the nodes of the mesh: means over the elements around, by volume.
std::vector<double> node_means(const Mesh<3>& mesh, const std::string& where,
                               const std::vector<double>& values);

/// A plane across an axis.
struct CutPlane {
  int axis = 1;     ///< 0, 1 or 2
  double at = 0.0;  ///< m
};
/// Reads `x=1.5`. Throws InputError, naming `command`.
CutPlane parse_cut(const std::string& text, const std::string& command);
std::string cut_text(const CutPlane& plane);

/// A cut as a plane model, with the regions and boundaries that it meets. Its coordinates are y and
/// z, x and z, or x and y.
struct PlaneCut {
  Sheet sheet;
  std::array<int, 2> axes{0, 2};
  Mesh<2> mesh;
};
/// Throws InputError, naming `command`, for a plane that misses the model.
PlaneCut plane_cut(const Mesh<3>& mesh, const CutPlane& plane, const std::string& command);

}  // namespace suffuse

#pragma once

/// Contours of a field that is linear between the nodes of a mesh.

#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

using Polyline = std::vector<Vector<2>>;

/// Lines along which the field has the value `level`, joined as far as possible; a closed line ends
/// where it starts. Elements with a value that is not finite are left out.
std::vector<Polyline> contour_lines(const Mesh<2>& mesh, const std::vector<double>& at_nodes,
                                    double level);

/// The part of a triangle in which a field, linear between its corners, is between two values: a
/// convex polygon, empty where there is none.
Polyline band_in_triangle(const std::array<Vector<2>, 3>& corners,
                          const std::array<double, 3>& values, double low, double high);

double length(const Polyline& line);
/// The point at this share of the length of a line.
Vector<2> place_on(const Polyline& line, double share);

}  // namespace suffuse

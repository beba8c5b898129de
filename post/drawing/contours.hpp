#pragma once

/// Contours of a field that is linear between the nodes of a mesh.

#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

using Polyline = std::vector<Vector<2>>;

/// The lines along which the field has the value `level`, each as long as it can be; a closed one
/// ends where it starts. They leave out elements with a value that is not finite.
std::vector<Polyline> contour_lines(const Mesh<2>& mesh, const std::vector<double>& at_nodes,
                                    double level);

/// The part of a triangle in which a field, linear between its corners, is between two values: a
/// convex polygon, empty where there is none.
Polyline band_in_triangle(const std::array<Vector<2>, 3>& corners,
                          const std::array<double, 3>& values, double low, double high);

double length(const Polyline& line);
/// The place on a line behind this share of its length.
Vector<2> place_on(const Polyline& line, double share);

}  // namespace suffuse

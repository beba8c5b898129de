#pragma once

/// Finds curves of the current Gmsh model that cross, which Gmsh reports as edges it cannot
/// recover.

#include <string>
#include <vector>

namespace suffuse {

/// The first few places at which two curves meet without a common point, or a curve meets itself,
/// each as `curves 2 and 4 that meet at (1, 0.5)`, in the model's unit of length. Uses the mesh of
/// the curves; creates it if necessary.
std::vector<std::string> curve_crossings();

}  // namespace suffuse

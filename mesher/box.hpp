#pragma once

/// The built-in geometry in three dimensions: a box of tetrahedra.

#include "column.hpp"
#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// [0, width] x [0, depth] over the column's levels, in cuboids of six tetrahedra, one for each
/// path along edges from a cuboid's first corner to its last (H. W. Kuhn, IBM J. Res. Dev. 4 (1960)
/// 518-524). Neighbours share their faces. Boundaries: both ends along z, "left" and "right" along
/// x, "front" and "back" along y.
Mesh<3> regular_box(const ColumnShape& column, double depth, double size);

/// Meshes the box of `regular_box` with unstructured tetrahedra in the current Gmsh model. Throws
/// the exceptions of Gmsh for its own errors.
void mesh_free_box(const ColumnShape& column, double depth, double size);

}  // namespace suffuse

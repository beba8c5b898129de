#pragma once

/// Meshes of tetrahedra for the stress study.

#include <string>

#include "mesh/mesh.hpp"

namespace suffuse::stress {

enum class SpaceShape {
  column,  ///< driven at `top` and `bottom`
  layers,  ///< a column between layers of free water and soil, driven at `inflow` and `outflow`
  block,   ///< driven at `left` and `right`
  dam      ///< a block with slopes on the left and on the right
};
std::string name_of(SpaceShape shape);

/// A plane inside, or a part of it, that is a boundary `cut` with two sides, for a wall or a well.
enum class Cut { none, part, any };

/// A mesh 1 m high (the specimen, if there are layers), 0.3 to 2 m wide and deep, of 72 to about
/// 1500 elements, regular, disturbed or by Gmsh, with up to four soils, one of which is `specimen`.
/// There are no cuts between layers.
Mesh<3> space_mesh(unsigned seed, SpaceShape shape, Cut cut);

}  // namespace suffuse::stress

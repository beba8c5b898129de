#pragma once

/// Writes the mesh as a .msh file that Gmsh can show.

#include <string>

#include "mesh/mesh.hpp"

namespace suffuse {

/// Writes a Gmsh 4.1 file with the regions and boundaries as physical groups, and `path`.opt next
/// to it, which Gmsh loads too: it has the colour of each region, because a .msh file has no
/// colours. Throws FileError.
template <int Dim>
void write_gmsh(const std::string& path, const Mesh<Dim>& mesh);

}  // namespace suffuse

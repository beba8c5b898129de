#pragma once

/// Reads and meshes a user's geometry file with Gmsh, in a confined process.

#include "geometry.hpp"
#include "gmsh_reply.hpp"

namespace suffuse {

/// The model of the file that the scene names, meshed. A geometry file is a program in Gmsh's
/// language, with commands that run other programs and write files: Gmsh runs in a confined child
/// (`confined_child.hpp`), and this process receives only numbers and names. Throws InputError for
/// forbidden actions, a crash, an exceeded limit, and Gmsh's own errors. Throws FileError if there
/// is no such file, and if this system cannot confine a process.
GmshReply read_geometry_file(const GeometryRequest& request);

}  // namespace suffuse

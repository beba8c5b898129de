#pragma once

/// Reads and meshes a user's geometry file with Gmsh, in a process that may do nothing else.

#include "geometry.hpp"
#include "gmsh_reply.hpp"

namespace suffuse {

/// The model of the file that the scene names, meshed. A geometry file is a program in Gmsh's
/// language, with commands that run other programs and write files: Gmsh runs in a confined child
/// (`confined_child.hpp`), and this process gets numbers and names alone. What a confined process
/// may not do, a crash and a limit that is passed come as an InputError, like Gmsh's own errors.
/// Throws FileError where there is no such file, and where this system cannot confine a process.
GmshReply read_geometry_file(const GeometryRequest& request);

}  // namespace suffuse

#pragma once

/// Reads and meshes a user's geometry file with Gmsh, in a confined process.

#include "gmsh_reply.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// The model of the file that the scene names, meshed. A geometry file is a program in Gmsh's
/// language, with commands that run other programs and write files: Gmsh runs in a confined child
/// (`confined_child.hpp`), and this process receives only numbers and names. Throws InputError for
/// forbidden actions, a crash, an exceeded limit, and Gmsh's own errors. Throws FileError if there
/// is no such file, and if this system cannot confine a process.
/// \param max_seconds  of processor time that Gmsh may take; infinite: no limit
GmshReply read_geometry_file(const SceneDocument& document, double max_seconds);

}  // namespace suffuse

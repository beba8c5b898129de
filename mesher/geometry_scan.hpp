#pragma once

/// Checks a user's geometry file, and every file that it includes, before Gmsh executes it.

#include <string>
#include <vector>

#include "case/errors.hpp"

namespace suffuse {

/// A .geo file is a program: it can run shell commands, write files and end the process. Returns
/// one problem, with `FILE:LINE`, for every such command, for every file drawn in under a name that
/// is not a plain string, and for every file that is not what its ending says. Files that Gmsh
/// would open on its own (`FILE.opt`) are included. Throws FileError when a file cannot be read.
std::vector<InputProblem> scan_geometry_file(const std::string& path);

}  // namespace suffuse

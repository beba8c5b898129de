#pragma once

/// Snapshots as VTK's XML files, for tools that do not read VTKHDF.

#include <string>

#include "results/reader.hpp"

namespace suffuse {

/// Writes mesh.pvd, solid.pvd, of a double-point run liquid.pvd, and the .vtu files they name into
/// `folder`, which is made if it is not there. Throws FileError.
void export_vtu(const ResultsReader& results, const std::string& folder);

}  // namespace suffuse

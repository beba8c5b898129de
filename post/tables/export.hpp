#pragma once

/// Export of snapshots to VTK's XML files, for tools that cannot read VTKHDF.

#include <string>

#include "results/reader.hpp"

namespace suffuse {

/// Writes mesh.pvd, solid.pvd and, for a double-point run, liquid.pvd, with the .vtu files that
/// they name, into `folder`. Creates the folder if there is none. Throws FileError.
void export_vtu(const ResultsReader& results, const std::string& folder);

}  // namespace suffuse

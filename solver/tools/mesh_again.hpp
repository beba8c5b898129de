#pragma once

/// The mode --sizes: how far the discharge of a case can be off, and sizes of elements for a mesh
/// on which it is off by no more than `mesh.error`.

#include <string>

#include "case/case_file.hpp"

namespace suffuse {

struct SizesOptions {
  std::string output;  ///< file of sizes, for suffuse-mesher --sizes
  std::string run;     ///< results folder of a run of the case; empty: the steady flow at its start
  int threads = 1;
};

/// Writes the file, and says on standard output between which values the discharge lies and whether
/// `mesh.error` is met (1 % where the scene has none). In a run that is the discharge of the moment
/// at which least is known, each element has its largest error of all snapshots, and `mesh.error`
/// is a share of the largest discharge. Runs nothing. Throws InputError where the scheme has no
/// bounds, where nothing flows, and where the run is none of this case, is not done, or has no
/// errors; NumericalError and FileError.
template <int Dim>
void write_sizes(Case<Dim> c, const SizesOptions& options);

}  // namespace suffuse

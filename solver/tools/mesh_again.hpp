#pragma once

/// The mode --sizes: the steady flow of a case, how far its discharge can be off, and sizes of
/// elements for a mesh on which it is off by no more than `mesh.error`.

#include <string>

#include "case/case_file.hpp"

namespace suffuse {

struct SizesOptions {
  std::string output;  ///< file of sizes, for suffuse-mesher --sizes
  int threads = 1;
};

/// Writes the file, and says on standard output between which values the discharge lies and whether
/// `mesh.error` is met (1 % where the scene has none). Runs nothing. Throws InputError where the
/// scheme has no bounds, NumericalError and FileError.
template <int Dim>
void write_sizes(Case<Dim> c, const SizesOptions& options);

}  // namespace suffuse

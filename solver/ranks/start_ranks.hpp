#pragma once

/// The ranks of a program: `start_alone.cpp` is linked with suffuse-solver, `start_mpi.cpp` with
/// suffuse-solver-mpi.

#include <memory>

#include "ranks/ranks.hpp"

namespace suffuse {

/// Starts what the ranks need, once; it ends with the last of the returned pointers.
std::shared_ptr<const Ranks> start_ranks();

}  // namespace suffuse

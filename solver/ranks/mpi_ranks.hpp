#pragma once

/// Ranks that are processes of MPI, by PETSc. Sources of the library suffuse_mpi include this, no
/// others do.

#include <memory>

#include "ranks/ranks.hpp"

namespace suffuse {

/// Starts PETSc and MPI, and ends them.
class MpiProcess {
 public:
  MpiProcess();
  ~MpiProcess();
  MpiProcess(const MpiProcess&) = delete;
  MpiProcess& operator=(const MpiProcess&) = delete;
};

/// All processes that mpirun started. An MpiProcess has to outlive them, and what they made.
std::shared_ptr<const Ranks> mpi_ranks();

}  // namespace suffuse

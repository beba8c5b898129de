#pragma once

#include <stdexcept>
#include <string>

namespace suffuse {

/// Throws if a call of PETSc or MPI returned an error.
inline void petsc_check(int error, const char* call) {
  if (error != 0) throw std::runtime_error(std::string(call) + " failed: " + std::to_string(error));
}

}  // namespace suffuse

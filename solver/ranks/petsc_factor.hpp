#pragma once

/// Conjugate gradients of PETSc with hypre's BoomerAMG.

#include <memory>

#include "ranks/shared_factor.hpp"

namespace suffuse {

std::unique_ptr<SharedFactor> petsc_factor();

}  // namespace suffuse

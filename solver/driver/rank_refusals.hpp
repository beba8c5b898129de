#pragma once

/// What runs in one process only.

#include "case/case_file.hpp"
#include "driver/run.hpp"

namespace suffuse {

/// Throws InputError that names what of the scene or of the options cannot run on several ranks.
template <int Dim>
void refuse_on_ranks(const Case<Dim>& c, const RunOptions& run);

}  // namespace suffuse

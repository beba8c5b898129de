#pragma once

/// What runs in one process only.

#include "case/case_file.hpp"

namespace suffuse {

/// Throws InputError that names what of the scene cannot run on several ranks. `transports`: fines
/// can be in the liquid.
template <int Dim>
void refuse_on_ranks(const Case<Dim>& c, bool transports);

}  // namespace suffuse

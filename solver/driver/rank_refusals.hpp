#pragma once

/// What runs in one process only.

#include "case/case_file.hpp"

namespace suffuse {

/// Throws InputError that names what of the scene cannot run on several ranks.
template <int Dim>
void refuse_on_ranks(const Case<Dim>& c);

}  // namespace suffuse

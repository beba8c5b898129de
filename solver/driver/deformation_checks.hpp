#pragma once

/// What the solver does not do yet with skeletons that move.

#include "case/case_file.hpp"

namespace suffuse {

/// Throws InputError where a soil has a law of the skeleton.
void refuse_moving_skeletons(const SceneDocument& document);

}  // namespace suffuse

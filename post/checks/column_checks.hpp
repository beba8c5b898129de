#pragma once

/// Heave and uplift by EN 1997-1, column by column under the ground.

#include <vector>

#include "checks/check_row.hpp"
#include "scene/check_settings.hpp"

namespace suffuse {

/// Rows of `hyd-stresses` and `hyd-forces` for each boundary and region whose ground water leaves
/// through, of `hyd-stresses` also where water below open ground would rise above it, and of
/// `uplift` for each where the cover is the ground: the worst column down to any depth, at any
/// snapshot. None for soil that moves. Throws FileError.
std::vector<CheckRow> column_checks(const ResultsReader& results, const CheckSettings& settings);

}  // namespace suffuse

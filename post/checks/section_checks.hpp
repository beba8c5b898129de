#pragma once

/// Backward erosion and blanket theory, for plane sections.

#include <vector>

#include "checks/check_row.hpp"
#include "scene/check_settings.hpp"

namespace suffuse {

/// A row of `backward-erosion`: the critical head of Sellmeijer against the largest difference of
/// head from entry to exit. Throws FileError; InputError where the drawing does not say a length
/// that the settings lack, as under gravity that is not along y, and in three dimensions.
std::vector<CheckRow> backward_erosion_checks(const ResultsReader& results,
                                              const BackwardErosionSettings& settings);

/// A row of `blanket`: the critical gradient of the cover against that at the landside toe by
/// blanket theory, with the head computed there in its note. Throws FileError; InputError, also for
/// gravity that is not along y.
std::vector<CheckRow> blanket_checks(const ResultsReader& results, const BlanketSettings& settings);

}  // namespace suffuse

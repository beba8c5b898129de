#pragma once

/// The figure of the gradations.

#include <vector>

#include "drawing/chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// The gradation of every soil that has one, finer by mass over size, with a marker at F*, and
/// beneath the legend what each check says of it. Equal soils of several runs are drawn once.
/// Throws FileError where no soil has a gradation.
Chart gradation_chart(const std::vector<ResultsReader>& runs);

}  // namespace suffuse

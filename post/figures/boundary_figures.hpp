#pragma once

/// Charts of the liquid and the grains that cross each boundary of the scene, against time.

#include "drawing/chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Discharge out of the model through each boundary, and the grains that left through it; the
/// second chart only if grains left. Throws FileError when a table has fewer than two times.
std::vector<Chart> boundary_charts(const std::vector<ResultsReader>& runs);

}  // namespace suffuse

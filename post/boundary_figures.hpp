#pragma once

/// What crosses each boundary of the scene: charts against time, and the balance at the end.

#include "chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Discharge out of the model through each boundary, and the grains that left through it; the
/// second only where any did. Throws FileError when a table has fewer than two times.
std::vector<Chart> boundary_charts(const std::vector<ResultsReader>& runs);

/// The last row of every boundary and their sums, as text.
std::string boundaries_text(const ResultsReader& results);

}  // namespace suffuse

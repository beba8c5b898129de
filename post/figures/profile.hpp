#pragma once

/// The figure "profile": fields along a line at several times.

#include <vector>

#include "drawing/chart.hpp"
#include "figures/figure_options.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// A chart per field (per component of a vector), with a curve per run and time, against the
/// distance from the first end of the line. Throws InputError, FileError.
std::vector<Chart> profile_charts(const std::vector<ResultsReader>& runs,
                                  const FigureOptions& options);

}  // namespace suffuse

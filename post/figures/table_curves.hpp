#pragma once

/// The figure "curves": any column of any table of one or more runs.

#include <string>
#include <vector>

#include "drawing/chart.hpp"
#include "figures/figure_options.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// A chart per column, with a curve per run. A column is named COLUMN, or TABLE.COLUMN where
/// several tables have it and the first is not the one that is wanted: history, ledger, regions,
/// boundaries, probes, sections. Of the last four, which have rows for each of several things,
/// there is a curve for each, or with :NAME for one: `boundaries.discharge:downstream`,
/// `probes.head:0`. Throws InputError, FileError.
std::vector<Chart> table_curves(const std::vector<ResultsReader>& runs,
                                const FigureOptions& options);

}  // namespace suffuse

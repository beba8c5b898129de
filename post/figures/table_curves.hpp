#pragma once

/// The figure "curves": any column of any table of one or more runs.

#include <string>
#include <vector>

#include "drawing/chart.hpp"
#include "figures/figure_options.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// A chart per column, with a curve per run. A column is named COLUMN, or TABLE.COLUMN to choose
/// one of several tables that have it: history, ledger, regions, boundaries, probes, sections. The
/// last four have rows for several things: each thing gets a curve, or with :NAME only the named
/// one does: `boundaries.discharge:downstream`, `probes.head:0`. Throws InputError, FileError.
std::vector<Chart> table_curves(const std::vector<ResultsReader>& runs,
                                const FigureOptions& options);

}  // namespace suffuse

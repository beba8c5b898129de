#pragma once

/// The figure "fines-lost": what seepage tests in a laboratory measure.

#include <string>
#include <vector>

#include "drawing/chart.hpp"
#include "figures/measured.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Reads a table with the columns `run`, `hours`, and `fines_lost`, `conductance` or both. Throws
/// InputError or FileError.
MeasuredPoints read_measured_points(const std::string& path);

/// Fines that have left, in per cent of the initial ones, against hours; without gravity also the
/// conductance: discharge over difference of pressures, relative to the start. Throws FileError for
/// a run without fines, InputError for points of a run that is missing.
std::vector<Chart> fines_lost_charts(const std::vector<ResultsReader>& runs,
                                     const MeasuredPoints& measured = {});

}  // namespace suffuse

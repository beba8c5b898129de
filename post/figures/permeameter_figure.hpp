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

/// Fines that have left, in per cent of those that were there, against hours. Where no gravity acts
/// also the conductance: discharge over difference of pressures, over that at the start. Throws
/// FileError for a run without fines, InputError for points of a run that is not there.
std::vector<Chart> fines_lost_charts(const std::vector<ResultsReader>& runs,
                                     const MeasuredPoints& measured = {});

}  // namespace suffuse

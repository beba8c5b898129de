#pragma once

/// Charts of a sweep: results of its runs, over a key or in time, with bands.

#include <string>
#include <vector>

#include "drawing/chart.hpp"
#include "scene/scene.hpp"
#include "tables/sweep_table.hpp"

namespace suffuse {

/// The value below which a share of all lies, linear between the values in ascending order (type 7
/// of Hyndman and Fan 1996). `sorted` is ascending and not empty.
double quantile(const std::vector<double>& sorted, double share);

/// Groups of runs with similar x: runs of equal x, or up to ten groups of equal count. There is no
/// group if there are few runs.
std::vector<std::vector<std::size_t>> groups_of(const std::vector<double>& x);

/// A chart for each of the columns `y`: all runs over the column `x`, their median and the band
/// from 10 to 90 %. With too few runs for a band, a line joins the runs. `scene` is that of a run;
/// the unit of x may depend on it. The x axis is logarithmic where values cover a factor of 30.
std::vector<Chart> over_key_charts(const SweepTable& sweep, const std::string& x,
                                   const std::vector<std::string>& y, const Scene* scene = nullptr);

/// A chart for each column: the share of runs with less than a value.
std::vector<Chart> distribution_charts(const SweepTable& sweep, const std::vector<std::string>& y);

/// A chart for each column of history.csv or ledger.csv: all runs in time, their median and the
/// band from 10 to 90 %, up to the earliest end of a run. Throws FileError where results cannot be
/// read, InputError for other columns.
std::vector<Chart> over_time_charts(const SweepTable& sweep,
                                    const std::vector<std::string>& columns);

}  // namespace suffuse

#pragma once

/// The report of one or more runs: a page that needs no other file and requests nothing from a
/// network.

#include <string>
#include <vector>

#include "report/report_progress.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// The page as HTML. Throws FileError, InputError for a table that is none.
/// \param tables    CSV files to show on the first page
/// \param progress  is told of each part; of several runs, with the name of the run
std::string report_html(const std::vector<ResultsReader>& runs,
                        const std::vector<std::string>& tables = {},
                        const ReportProgress& progress = {});

/// Writes the page, whole or not at all. Throws FileError.
void write_report(const std::vector<ResultsReader>& runs, const std::string& path,
                  const std::vector<std::string>& tables = {}, const ReportProgress& progress = {});

}  // namespace suffuse

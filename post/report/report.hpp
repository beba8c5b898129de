#pragma once

/// The report of one or more runs: a page that needs no other file and requests nothing from a
/// network.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// The page as HTML. Throws FileError, InputError for a table that is none.
/// \param tables  CSV files to show on the first page
std::string report_html(const std::vector<ResultsReader>& runs,
                        const std::vector<std::string>& tables = {});

/// Writes the page, whole or not at all. Throws FileError.
void write_report(const std::vector<ResultsReader>& runs, const std::string& path,
                  const std::vector<std::string>& tables = {});

}  // namespace suffuse

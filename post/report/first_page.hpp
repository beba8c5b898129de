#pragma once

/// The first page of a report, for a reader who opens no other: what was found, for each mechanism
/// its factor, how sure the numbers are, what was not looked at.

#include <string>
#include <vector>

#include "report/run_numbers.hpp"

namespace suffuse {

/// Summary, mechanisms, error bars and gaps of one run, as HTML.
std::string first_page(const ResultsReader& run, const RunNumbers& numbers);

/// A CSV file as a table with its name, such as factors of safety or critical levels. Throws
/// FileError, InputError for a file without a line of names and for rows of other lengths.
std::string table_file_html(const ResultsReader& run, const std::string& path);

}  // namespace suffuse

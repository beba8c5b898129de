#pragma once

/// The part of a report that is about one run.

#include <string>

#include "report/report_progress.hpp"
#include "report/run_numbers.hpp"

namespace suffuse {

/// Model, scene, plan, warnings, tables, fields, safety, and how to repeat the run. `id` is the
/// start of its anchors. Throws FileError.
std::string run_section(const ResultsReader& run, const RunNumbers& numbers, const std::string& id,
                        const ReportProgress& progress = {});

/// An argument for a shell: in quotes if it has characters other than letters, digits and ._-/=
std::string shell_argument(const std::string& text);

}  // namespace suffuse

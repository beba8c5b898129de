#pragma once

/// The pictures of a report, drawn into files of a temporary folder and put into the page.

#include <string>
#include <vector>

#include "files/time_unit.hpp"
#include "report/report_progress.hpp"
#include "results/reader.hpp"
#include "tables/table_output.hpp"

namespace suffuse {

/// At most `count` snapshots, evenly in time, the first and the last among them.
std::vector<std::size_t> snapshots_evenly(const std::vector<double>& times, std::size_t count);

/// The sketch of a run's model. Throws FileError, as all that follow.
std::string model_html(const ResultsReader& run, const ReportProgress& progress = {});

/// Charts of the columns of tables that all runs have, with a curve per run.
std::string curves_html(const std::vector<ResultsReader>& runs,
                        const ReportProgress& progress = {});

/// Factors of safety at their times, s, next to the heads that change in time at the boundaries of
/// the run.
std::string factor_html(const ResultsReader& run, const std::vector<double>& times,
                        const std::vector<double>& factors);

/// Fields of a run at up to twelve times, with a slider: head, change of porosity, concentration,
/// safety. A field that is constant in space and time is described by a sentence.
std::string fields_html(const ResultsReader& run, const ReportProgress& progress = {});

}  // namespace suffuse

#pragma once

/// Names of runs in figures and tables.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// The name of the results folder, without its path and without `.results`.
std::string folder_name(const ResultsReader& run);

/// The names of the folders, with as much of their paths before them as tells equal names apart:
/// `a/run` and `b/run`.
std::vector<std::string> folder_names(const std::vector<ResultsReader>& runs);

/// One label per run: the name of its scene, or of its folder where scenes have equal names. It
/// includes the formulation where there are both, and the status of a run that is not done.
std::vector<std::string> run_labels(const std::vector<ResultsReader>& runs);

/// True when both formulations are among the runs.
bool is_mixed(const std::vector<ResultsReader>& runs);

bool is_double_point(const ResultsReader& run);

}  // namespace suffuse

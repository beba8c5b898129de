#pragma once

/// Which snapshot is drawn.

#include <optional>
#include <string>

#include "results/reader.hpp"

namespace suffuse {

/// Throws FileError where a run has no snapshot yet, or where a list of its snapshots is lost,
/// which then is named.
void expect_snapshots(const ResultsReader& results);
/// Throws FileError, naming it, where a list of the snapshots of a run that has some is lost.
void expect_lists_of_snapshots(const ResultsReader& results);

/// The snapshot nearest to `time` (s), or the last. A time up to half an interval outside the
/// snapshots stands for the first or the last one. Throws InputError, naming `command`, for any
/// other; FileError where there is no snapshot yet.
std::size_t chosen_snapshot(const ResultsReader& results, const std::optional<double>& time,
                            const std::string& command);

}  // namespace suffuse

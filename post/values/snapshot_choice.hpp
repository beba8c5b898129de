#pragma once

/// Which snapshot is drawn.

#include <optional>
#include <string>

#include "results/reader.hpp"

namespace suffuse {

/// The snapshot nearest to `time` (s), or the last. A time outside the snapshots is taken for the
/// first or last of them up to half an interval away. Throws InputError, naming `command`, for any
/// other; FileError where there is no snapshot yet.
std::size_t chosen_snapshot(const ResultsReader& results, const std::optional<double>& time,
                            const std::string& command);

}  // namespace suffuse

#pragma once

/// Heads and pressures of boundaries that are highest between snapshots, where no check looks.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// A sentence for each prescribed head or pressure whose largest value between the first and the
/// last snapshot exceeds that at any snapshot by more than 1 % of its range.
std::vector<std::string> unseen_peaks(const ResultsReader& results);

}  // namespace suffuse

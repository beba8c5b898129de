#pragma once

/// Filters: soils with a gradation next to each other, where water flows from one into the other.

#include <vector>

#include "checks/check_row.hpp"

namespace suffuse {

/// Rows of `filter`, `filter-retention` and `filter-drainage` for each such pair, by the direction
/// of the flow from one into the other in the last snapshot. Throws FileError.
std::vector<CheckRow> filter_checks(const ResultsReader& results);

}  // namespace suffuse

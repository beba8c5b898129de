#pragma once

/// What gradations say: whether the fines of a soil can move between its coarse grains, and whether
/// a soil next to another holds back what water washes out of it.

#include <vector>

#include "checks/check_row.hpp"

namespace suffuse {

/// Rows of `filter`, `filter-retention` and `filter-drainage` for each such pair, where water flows
/// from the first into the second in some snapshot. Throws FileError.
std::vector<CheckRow> filter_checks(const ResultsReader& results);

/// Rows of `internal-stability` for each region with a gradation: H/F of Kenney and Lau, which is
/// at least 1 where coarse grains hold the fines; the note has the verdicts of the other criteria.
std::vector<CheckRow> stability_checks(const ResultsReader& results);

}  // namespace suffuse

#pragma once

/// Whether fines begin to erode, and how much a region has lost.

#include <vector>

#include "checks/check_row.hpp"

namespace suffuse {

/// A row of `erosion` for each soil that can erode: the largest drive of the erosion law against
/// its threshold; without a threshold, a row without a factor. Throws FileError.
std::vector<CheckRow> threshold_checks(const ResultsReader& results);

/// A row of `loss` for each soil that exchanges fines: the share of its dry mass before all stages
/// that has left it, in per cent, and its class of erosion by Douglas and others (2019): none up to
/// 0.2 %, some up to 1 %, excessive up to 5 %, continuing above. Without a factor: erosion has no
/// end here while it goes on.
std::vector<CheckRow> loss_checks(const ResultsReader& results);

}  // namespace suffuse

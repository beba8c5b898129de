#pragma once

/// Colours of fields.

#include "chart.hpp"

namespace suffuse {

/// Viridis at `fraction` (0 to 1, limited to that): dark to bright without a turn, so that it
/// survives grey printing. Fit of sixth degree by M. Zucker (2019) to the map of S. van der Walt
/// and N. Smith (2015).
Color viridis(double fraction);

/// Luminance of a colour, 0 to 1 (Rec. 709).
double luminance(const Color& color);

}  // namespace suffuse

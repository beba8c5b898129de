#pragma once

/// The table of short texts beneath the legend of a chart.

#include <vtkContext2D.h>

#include "drawing/chart.hpp"

namespace suffuse {

/// Pixels; 0 without rows. The height includes the room above.
float table_width(const ChartTable& table);
float table_height(const ChartTable& table);

/// Paints rows from the top left corner on (pixels from the bottom left of the picture), with a
/// line beneath the heading.
void paint_table(vtkContext2D& painter, const ChartTable& table, float left, float top);

}  // namespace suffuse

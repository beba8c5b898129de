#pragma once

/// The bar of colours of a map: at its right, or below it where the map is low. It is as long as
/// the map.

#include <vtkContext2D.h>

#include <string>
#include <vector>

#include "drawing/chart.hpp"
#include "drawing/model_view.hpp"

namespace suffuse {

/// A value on a bar.
struct BarMark {
  double share;  ///< of the length of the bar, from its low end
  std::string text;
};

struct ColorBar {
  std::vector<Color> bands;  ///< of equal length, from the low end
  bool framed = false;       ///< lines around each band
  /// A mark is left out where it would touch one before it in this list.
  std::vector<BarMark> marks;
  std::string label;
  std::vector<std::string> notes{};  ///< at the end of the label, or below an upright bar
};

/// Whether the bar of this map lies below it.
bool has_lying_bar(const ModelView& view);
/// Room for the bar below the axes of the map, and at its right, pixels.
float room_below(const ModelView& view);
float room_at_right(const ModelView& view, const ColorBar& bar);

/// Paints the bar of a map; `gap`: distance of an upright bar from the map, pixels.
void paint_color_bar(vtkContext2D& painter, const ColorBar& bar, const ModelView& view, float gap);

}  // namespace suffuse

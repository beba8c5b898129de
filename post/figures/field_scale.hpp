#pragma once

/// The colours of a field's values: the range that they cover, its bar, its legend of kinds.

#include <vtkContext2D.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "drawing/color_bar.hpp"
#include "figures/categories.hpp"

namespace suffuse {

/// The colours of values: one per kind, or the colour map over a range.
struct FieldScale {
  std::array<double, 2> range{0.0, 1.0};
  bool logarithmic = false;
  bool uniform = false;            ///< all values agree up to round-off; the range is that value
  bool exceeds_low = false;        ///< some values are below the range
  bool exceeds_high = false;       ///< some values are above the range
  std::vector<std::string> notes;  ///< notes on values outside the range
  std::vector<Category> kinds;

  [[nodiscard]] Color color(double value) const;
  /// Position of a value in the range: 0 to 1 for values within it.
  [[nodiscard]] double fraction(double value) const;
  /// Round values within the range, ascending.
  [[nodiscard]] std::vector<double> levels() const;
  [[nodiscard]] std::string level_text(double level) const;
};

/// Grey, for values that are not numbers, or not positive on a logarithmic scale.
inline constexpr Color no_value{0.75, 0.75, 0.75};

/// A value with the area that it holds for, or with 1 for a point.
struct WeightedValue {
  double value;
  double weight;
};

struct ScaleRequest {
  std::optional<std::array<double, 2>> range{};  ///< unset: that of the values
  bool logarithmic = false;
  double round_off = 0.0;       ///< values of this size are zero, in the unit of the field
  std::string shares = "area";  ///< name of the quantity that the weights are shares of
};

/// The scale of values. Without a range in the request it covers all values. If the least or the
/// largest value is farther outside the 1st and 99th percentile than half the distance between
/// these, the range ends at the percentile, so that a few elements at a corner do not take all
/// colours. Values that agree up to round-off have one colour. A logarithmic range covers only
/// positive values.
FieldScale value_scale(std::vector<WeightedValue> values, const ScaleRequest& request);

/// The bar of a scale of numbers.
ColorBar bar_of(const FieldScale& scale, const std::string& label);
/// Paints the legend of kinds; `kinds_width` and `kinds_height` are its size, pixels.
void paint_kinds(vtkContext2D& painter, const FieldScale& scale, const std::string& label,
                 float left, float top);
float kinds_width(const FieldScale& scale, const std::string& label);
float kinds_height(const FieldScale& scale);

}  // namespace suffuse

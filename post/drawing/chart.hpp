#pragma once

/// Line charts with axes and one legend, as PNG, SVG or PDF. VTK draws them; no X server is needed.

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace suffuse {

using Color = std::array<double, 3>;

enum class Dash { solid, dashed, dash_dot, dash_dot_dot, dotted };
enum class Marker { circle, square, diamond, target };

/// One curve: a line (black for an exact solution), markers, or both; or the band between two.
struct Curve {
  std::string label;  ///< in the legend; empty leaves it out
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> low{};  ///< lower end of a band whose upper end is y; empty: no band
  bool markers = false;
  bool joined = false;              ///< draw a line through the markers too
  std::vector<std::size_t> marked;  ///< rows that get a marker; empty: all rows
  Dash dash = Dash::solid;
  float width = 2.0F;  ///< line width, pixels
  Marker marker = Marker::circle;
  bool hollow = false;  ///< white inside; a target gets a smaller dot
  Color color{0.0, 0.0, 0.0};

  [[nodiscard]] bool is_band() const { return !low.empty(); }
  [[nodiscard]] bool has_line() const { return joined || !(markers || is_band()); }
};

/// Rows of cells, the first row being the heading.
using ChartTable = std::vector<std::vector<std::string>>;

/// One chart: the texts of its axes and its curves.
struct Chart {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Curve> curves;      ///< later ones cover earlier ones
  std::vector<double> extra_x{};  ///< values that the axis covers in addition to the curves
  std::vector<double> extra_y{};
  bool logarithmic_x = false;  ///< values that are not positive are left out; likewise y
  bool logarithmic_y = false;
  std::optional<std::array<double, 2>> x_range{};  ///< ends of the axis; unset: those of the values
  std::optional<std::array<double, 2>> y_range{};
  ChartTable table{};  ///< drawn below the legend; of several charts, only the first one's table
};

/// Draws two charts side by side, three or more in rows of two, with one legend for all. The suffix
/// of `path` gives the format. Throws InputError for an unknown suffix, FileError.
void draw_charts(const std::vector<Chart>& charts, const std::string& path);

}  // namespace suffuse

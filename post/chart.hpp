#pragma once

/// Charts of curves against time, as PNG, SVG or PDF, drawn with VTK's charts and no X server.

#include <array>
#include <string>
#include <vector>

namespace suffuse {

using Color = std::array<double, 3>;

enum class Dash { solid, dashed, dash_dot, dash_dot_dot, dotted };
enum class Marker { circle, square, diamond, target };

/// One curve: a line (black for an exact solution), markers, or both.
struct Curve {
  std::string label;  ///< in the legend; empty leaves it out
  std::vector<double> x;
  std::vector<double> y;
  bool markers = false;
  bool joined = false;              ///< a line too, where there are markers
  std::vector<std::size_t> marked;  ///< rows with a marker; all of them when empty
  Dash dash = Dash::solid;
  float width = 2.0F;  ///< of the line, pixels
  Marker marker = Marker::circle;
  bool hollow = false;  ///< white inside; a target has a smaller dot
  Color color{0.0, 0.0, 0.0};

  [[nodiscard]] bool has_line() const { return joined || !markers; }
};

struct Chart {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Curve> curves;      ///< later ones cover earlier ones
  bool logarithmic = false;       ///< both axes; all values are positive then
  std::vector<double> extra_x{};  ///< values that the axis covers too, beside those of the curves
  std::vector<double> extra_y{};
};

/// Draws charts beside one another, from three on in rows of two, with one legend for all. Throws
/// InputError for an unknown suffix, FileError.
void draw_charts(const std::vector<Chart>& charts, const std::string& path);

/// At least two round numbers that enclose [low, high], evenly spaced, 5 to 11 of them.
std::vector<double> round_ticks(double low, double high);

/// A tick as text.
std::string tick_text(double tick);

/// A logarithmic axis: what it reaches, and its labelled ticks.
struct LogarithmicTicks {
  double low = 0.0;
  double high = 0.0;
  std::vector<double> ticks;
};

/// Ends at 1, 2 or 5 times a power of ten that enclose [low, high] > 0; ticks at all of these in
/// between, beyond three decades at the powers alone.
LogarithmicTicks logarithmic_ticks(double low, double high);

/// A tick of a logarithmic axis as text.
std::string logarithmic_tick_text(double tick);

}  // namespace suffuse

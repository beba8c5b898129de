#pragma once

/// Charts of curves against time, as PNG, SVG or PDF, drawn with VTK's charts and no X server.

#include <array>
#include <string>
#include <vector>

namespace suffuse {

enum class Dash { solid, dashed, dash_dot, dash_dot_dot, dotted };
enum class Marker { circle, square, diamond, target };

/// One curve: a black line for an exact solution, or coloured markers for a run.
struct Curve {
  std::string label;  ///< in the legend; empty leaves it out
  std::vector<double> x;
  std::vector<double> y;
  bool markers = false;
  Dash dash = Dash::solid;
  Marker marker = Marker::circle;
  bool hollow = false;  ///< white inside; a target has a smaller dot
  std::array<double, 3> color{0.0, 0.0, 0.0};
};

struct Chart {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Curve> curves;  ///< later ones cover earlier ones
};

/// The suffix of `path`: ".png", ".svg" or ".pdf". Throws InputError for any other.
std::string picture_format(const std::string& path);

/// Throws FileError.
void draw_chart(const Chart& chart, const std::string& path);

/// At least two round numbers that enclose [low, high], evenly spaced, 5 to 11 of them.
std::vector<double> round_ticks(double low, double high);

}  // namespace suffuse

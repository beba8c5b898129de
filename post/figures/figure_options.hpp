#pragma once

/// Options of figures: what `suffuse-post figure` takes in addition to runs and a file.

#include <optional>
#include <string>
#include <vector>

namespace suffuse {

/// Ends, scales and units of the axes of charts.
struct AxisOptions {
  std::string time_unit;  ///< of charts against time in seconds; empty: s
  bool log_x = false;
  bool log_y = false;
  std::string x_range;  ///< "a:b"; empty: that of the values
  std::string y_range;
};

struct FigureOptions {
  std::optional<double> time{};        ///< of the snapshot of a map, s; the last without it
  std::string measured{};              ///< file of measured points, drawn with the curves
  std::optional<int> tubes{};          ///< of "flownet"; without it as many as make squares
  std::vector<std::string> columns{};  ///< of "curves": COLUMN or TABLE.COLUMN, then maybe :NAME
  std::string x{};                     ///< of "curves": the column along x; empty: t
  std::string line{};                  ///< of "profile": x0,y0:x1,y1
  std::string times{};                 ///< of "profile": times with commas between, s
  std::string fields{};                ///< of "profile": names with commas between
  int count = 201;                     ///< of "profile": points on the line
  bool change = false;                 ///< of "profile": since the start
  AxisOptions axes{};                  ///< of all charts
};

}  // namespace suffuse

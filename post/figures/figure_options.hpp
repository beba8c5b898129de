#pragma once

/// Options of figures: what `suffuse-post figure` takes in addition to runs and a file.

#include <optional>
#include <string>
#include <vector>

namespace suffuse {

/// Ends, scales and units of the axes of charts.
struct AxisOptions {
  std::string time_unit;  ///< unit of time in charts; empty: that which fits
  bool log_x = false;
  bool log_y = false;
  std::string x_range;  ///< "a:b"; empty: the range of the values
  std::string y_range;
};

struct FigureOptions {
  std::optional<double> time{};        ///< time of the snapshot of a map, s; unset: the last
  std::string measured{};              ///< file of measured points, drawn with the curves
  std::optional<int> tubes{};          ///< for "flownet"; unset: as many as make squares
  std::vector<std::string> columns{};  ///< for "curves": COLUMN or TABLE.COLUMN, then maybe :NAME
  std::string x{};                     ///< for "curves": the column along x; empty: t
  std::string line{};                  ///< for "profile": x0,y0:x1,y1
  std::string times{};                 ///< for "profile": times separated by commas, s
  std::string fields{};                ///< for "profile": names separated by commas
  int count = 201;                     ///< for "profile": points on the line
  bool change = false;                 ///< for "profile": show the change since the start
  AxisOptions axes{};                  ///< for all charts
};

}  // namespace suffuse

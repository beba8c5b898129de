#include "figures/measured.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "figures/run_curves.hpp"
#include "files/number_text.hpp"
#include "files/table_files.hpp"
#include "tables/table_output.hpp"
#include "values/refusal.hpp"

namespace suffuse {
namespace {

bool has_runs(const std::string& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  const auto names = csv_cells(line);
  return std::ranges::find(names, "run") != names.end();
}

void check_measured(const Table& table, const std::string& path) {
  for (std::size_t k = 0; k < table.names.size(); ++k) {
    for (const double value : table.columns[k]) {
      if (!std::isfinite(value)) {
        refuse_measured(path + ": " + table.names[k], number_text(value), "a number");
      }
    }
    if (const std::string now = renamed_column(table.names[k]); !now.empty()) {
      refuse_measured(path, "a column " + table.names[k], now + ", the name of today");
    }
  }
}

}  // namespace

void refuse_measured(const std::string& where, const std::string& found,
                     const std::string& expected) {
  refuse("suffuse-post figure", "--measured " + where, found, expected);
}

MeasuredPoints read_measured(const std::string& path) {
  MeasuredPoints measured{path, {}};
  if (has_runs(path)) {
    measured.runs = read_tables(path, "run");
  } else {
    measured.runs.push_back({"", read_table(path)});
  }
  for (NamedTable& run : measured.runs) {
    check_measured(run.table, path);
    run.table = with_seconds(std::move(run.table), path);
  }
  return measured;
}

void add_measured(const MeasuredPoints& measured, const std::string& x, const std::string& column,
                  const std::vector<std::string>& labels, Chart& chart) {
  for (const NamedTable& points : measured.runs) {
    if (!points.table.has(x) || !points.table.has(column)) continue;
    const auto run = std::ranges::find(labels, points.name);
    if (!points.name.empty() && run == labels.end()) {
      refuse_measured(measured.path, '"' + points.name + '"', quoted_list(labels));
    }
    const RunStyle style = curve_style(points.name.empty() ? 0 : run - labels.begin());
    Curve curve;
    curve.label = points.name.empty() ? "measured" : points.name + ", measured";
    curve.x = points.table.column(x);
    curve.y = points.table.column(column);
    curve.markers = true;
    curve.marker = style.marker;
    curve.hollow = style.hollow;
    curve.color = points.name.empty() ? Color{0.0, 0.0, 0.0} : style.color;
    chart.curves.push_back(curve);
  }
}

}  // namespace suffuse

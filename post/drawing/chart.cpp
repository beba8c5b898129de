#include "drawing/chart.hpp"

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartXY.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotArea.h>
#include <vtkPlotPoints.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "drawing/chart_legend.hpp"
#include "drawing/chart_table.hpp"
#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"

namespace suffuse {
namespace {

constexpr int min_width = 1200;
/// Size of the axes of one chart, and the room around them for titles and labels, pixels.
constexpr float plot_width = 720.0F;
constexpr float plot_height = 630.0F;
constexpr float left_room = 120.0F;
constexpr float bottom_room = 90.0F;
constexpr float room_above_chart = 80.0F;
constexpr float margin = 30.0F;
constexpr float cell_width = left_room + plot_width + margin;
constexpr float cell_height = bottom_room + plot_height + room_above_chart;

/// The rows of a curve as VTK's charts want them: all, or those with a marker.
vtkSmartPointer<vtkTable> table_of(const Curve& curve, bool marked_only) {
  vtkNew<vtkDoubleArray> x;
  vtkNew<vtkDoubleArray> y;
  x->SetName("x");
  y->SetName("y");
  const auto add = [&](std::size_t row) {
    x->InsertNextValue(curve.x[row]);
    y->InsertNextValue(curve.y[row]);
  };
  if (marked_only && !curve.marked.empty()) {
    for (const std::size_t row : curve.marked) add(row);
  } else {
    for (std::size_t row = 0; row < curve.x.size(); ++row) add(row);
  }
  auto table = vtkSmartPointer<vtkTable>::New();
  table->AddColumn(x);
  table->AddColumn(y);
  return table;
}

void add_markers(vtkChartXY& chart, const Curve& curve, const MarkerLayer& layer) {
  const Color color = layer.white ? Color{1.0, 1.0, 1.0} : curve.color;
  auto* plot = vtkPlotPoints::SafeDownCast(chart.AddPlot(vtkChart::POINTS));
  plot->SetInputData(table_of(curve, true), 0, 1);
  plot->SetMarkerStyle(layer.shape);
  plot->SetMarkerSize(layer.size);
  plot->SetColor(color[0], color[1], color[2]);
}

void add_line(vtkChartXY& chart, const Curve& curve) {
  auto* plot = chart.AddPlot(vtkChart::LINE);
  plot->SetInputData(table_of(curve, false), 0, 1);
  plot->SetColor(curve.color[0], curve.color[1], curve.color[2]);
  plot->SetWidth(curve.width);
  plot->GetPen()->SetLineType(vtk_line_type(curve.dash));
}

void add_band(vtkChartXY& chart, Curve curve) {
  // VTK draws no area of two rows: the first is there twice.
  if (curve.x.size() == 2) {
    for (auto* column : {&curve.x, &curve.y, &curve.low})
      column->insert(column->begin(), column->front());
  }
  auto table = table_of(curve, false);
  vtkNew<vtkDoubleArray> low;
  low->SetName("low");
  for (const double value : curve.low) low->InsertNextValue(value);
  table->AddColumn(low);
  auto* plot = vtkPlotArea::SafeDownCast(chart.AddPlot(vtkChart::AREA));
  plot->SetInputData(table);
  plot->SetInputArray(0, "x");
  plot->SetInputArray(1, "low");
  plot->SetInputArray(2, "y");
  plot->GetBrush()->SetColorF(curve.color[0], curve.color[1], curve.color[2]);
}

void add_curve(vtkChartXY& chart, const Curve& curve) {
  if (curve.is_band()) add_band(chart, curve);
  // VTK reports a line through one point as an error.
  if (curve.has_line() && curve.x.size() > 1) add_line(chart, curve);
  if (!curve.markers) return;
  for (const auto& layer : marker_layers(curve)) add_markers(chart, curve, layer);
}

/// Ends and ticks of an axis, in the units that VTK draws in: logarithms on logarithmic axes.
struct AxisTicks {
  double low;
  double high;
  std::vector<double> positions;
  std::vector<std::string> labels;
};

AxisTicks even_axis(double low, double high) {
  const auto ticks = round_ticks(low, high);
  AxisTicks axis{ticks.front(), ticks.back(), ticks, {}};
  for (const double tick : ticks) axis.labels.push_back(tick_text(tick));
  return axis;
}

AxisTicks logarithmic_axis(double low, double high) {
  const LogarithmicTicks found = logarithmic_ticks(low, high);
  AxisTicks axis{std::log10(found.low), std::log10(found.high), {}, {}};
  for (const double tick : found.ticks) {
    axis.positions.push_back(std::log10(tick));
    axis.labels.push_back(logarithmic_tick_text(tick));
  }
  return axis;
}

/// Sets range and ticks. The range is a little wider than the ends, so that no marker is cut in
/// half.
void set_axis(vtkAxis& axis, const AxisTicks& ticks) {
  const double room = 0.025 * (ticks.high - ticks.low);
  axis.SetTitle("");
  axis.GetLabelProperties()->SetFontSize(18);
  axis.GetGridPen()->SetColorF(0.88, 0.88, 0.88);
  axis.SetBehavior(vtkAxis::FIXED);
  axis.SetRange(ticks.low - room, ticks.high + room);
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (std::size_t i = 0; i < ticks.positions.size(); ++i) {
    positions->InsertNextValue(ticks.positions[i]);
    labels->InsertNextValue(ticks.labels[i]);
  }
  axis.SetCustomTickPositions(positions, labels);
}

/// One axis of a chart.
struct ChartAxis {
  std::vector<double> Curve::*values;
  const std::vector<double>& extra;
  bool logarithmic;
  const std::optional<std::array<double, 2>>& range;
};

ChartAxis x_axis(const Chart& chart) {
  return {&Curve::x, chart.extra_x, chart.logarithmic_x, chart.x_range};
}

ChartAxis y_axis(const Chart& chart) {
  return {&Curve::y, chart.extra_y, chart.logarithmic_y, chart.y_range};
}

/// Ticks over the axis' range if it has one, otherwise over all curves and the extra values.
AxisTicks ticks_of(const Chart& chart, const ChartAxis& axis) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const auto include = [&](const std::vector<double>& all) {
    for (const double value : all) {
      if (!std::isfinite(value) || (axis.logarithmic && value <= 0.0)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  };
  for (const auto& curve : chart.curves) {
    include(curve.*axis.values);
    if (axis.values == &Curve::y) include(curve.low);
  }
  include(axis.extra);
  if (axis.range) {
    low = (*axis.range)[0];
    high = (*axis.range)[1];
  }
  if (axis.logarithmic) return low <= high ? logarithmic_axis(low, high) : logarithmic_axis(1, 10);
  return low <= high ? even_axis(low, high) : even_axis(0.0, 1.0);
}

/// A curve in the units that VTK draws in: logarithms on logarithmic axes. Points outside the range
/// of an axis are left out.
Curve drawn_curve(const Chart& chart, const Curve& curve) {
  const auto drawn = [](const ChartAxis& axis, double& value) {
    if (!std::isfinite(value) || (axis.logarithmic && value <= 0.0)) return false;
    if (axis.range && (value < (*axis.range)[0] || value > (*axis.range)[1])) return false;
    if (axis.logarithmic) value = std::log10(value);
    return true;
  };
  Curve result = curve;
  result.x.clear();
  result.y.clear();
  result.low.clear();
  result.marked.clear();
  for (std::size_t row = 0; row < curve.x.size(); ++row) {
    double x = curve.x[row];
    double y = curve.y[row];
    if (!drawn(x_axis(chart), x) || !drawn(y_axis(chart), y)) continue;
    if (curve.is_band()) {
      double low = curve.low[row];
      if (!drawn(y_axis(chart), low)) continue;
      result.low.push_back(low);
    }
    if (std::ranges::find(curve.marked, row) != curve.marked.end()) {
      result.marked.push_back(result.x.size());
    }
    result.x.push_back(x);
    result.y.push_back(y);
  }
  return result;
}

/// Adds a chart with the lower left corner of its cell at (x, y). Titles are painted separately:
/// VTK's own are so close that they overlap the tick labels in viewers with wider letters.
void add_chart(vtkContextScene& scene, const Chart& chart, float x, float y) {
  vtkNew<vtkChartXY> drawn;
  drawn->SetShowLegend(false);
  drawn->SetAutoSize(false);
  drawn->SetLayoutStrategy(vtkChart::AXES_TO_RECT);
  const float left = x + left_room;
  const float bottom = y + bottom_room;
  drawn->SetSize(vtkRectf(left, bottom, plot_width, plot_height));
  for (const auto& curve : chart.curves) add_curve(*drawn, drawn_curve(chart, curve));
  set_axis(*drawn->GetAxis(vtkAxis::BOTTOM), ticks_of(chart, x_axis(chart)));
  set_axis(*drawn->GetAxis(vtkAxis::LEFT), ticks_of(chart, y_axis(chart)));
  scene.AddItem(drawn);
  add_painted(scene, [chart, left, bottom](vtkContext2D& painter) {
    const float center = left + plot_width / 2.0F;
    paint_text(painter, chart.title, 24, center, bottom + plot_height + 40.0F);
    paint_text(painter, chart.x_label, 21, center, bottom - 60.0F);
    paint_text(painter, chart.y_label, 21, left - 92.0F, bottom + plot_height / 2.0F,
               Anchor::center, 90.0);
  });
}

/// One row for each label of any chart.
std::vector<Curve> legend_rows(const std::vector<Chart>& charts) {
  std::vector<Curve> rows;
  for (const auto& chart : charts) {
    for (const auto& curve : chart.curves) {
      const auto same = [&](const Curve& row) { return row.label == curve.label; };
      if (curve.label.empty() || std::ranges::any_of(rows, same)) continue;
      rows.push_back(curve);
    }
  }
  return rows;
}

}  // namespace

void draw_charts(const std::vector<Chart>& charts, const std::string& path) {
  const auto rows = legend_rows(charts);
  const std::size_t count = charts.size();
  const std::size_t columns = count < 3 ? count : 2;
  const std::size_t lines = (count + columns - 1) / columns;
  // An odd number of charts leaves a cell free for the legend.
  const bool legend_in_cell = lines * columns > count;
  const float legend_left =
      static_cast<float>(legend_in_cell ? columns - 1 : columns) * cell_width +
      (legend_in_cell ? left_room : 0);
  const float legend_top =
      (legend_in_cell ? 1.0F : static_cast<float>(lines)) * cell_height - room_above_chart;
  const float height = static_cast<float>(lines) * cell_height;
  const ChartTable& table = charts.front().table;
  const float legend_width = std::max(ChartLegend::width(rows), table_width(table));
  // Without a legend there is nothing next to the charts.
  const float charts_width = static_cast<float>(columns) * cell_width;
  const float width =
      rows.empty() && table.empty()
          ? charts_width
          : std::max({legend_left + legend_width + margin, charts_width, float{min_width}});
  draw_picture(static_cast<int>(width), static_cast<int>(height), charts.front().title, path,
               [&](vtkContextScene& scene) {
                 for (std::size_t i = 0; i < count; ++i) {
                   const std::size_t line = lines - 1 - i / columns;
                   add_chart(scene, charts[i], static_cast<float>(i % columns) * cell_width,
                             static_cast<float>(line) * cell_height);
                 }
                 vtkNew<ChartLegend> legend;
                 legend->place(legend_left, legend_top, legend_top - margin - table_height(table),
                               rows);
                 scene.AddItem(legend);
                 const float table_top = legend_top - legend->height();
                 add_painted(scene, [=](vtkContext2D& painter) {
                   paint_table(painter, table, legend_left, table_top);
                 });
               });
}

}  // namespace suffuse

#include "chart.hpp"

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartXY.h>
#include <vtkContext2D.h>
#include <vtkContextActor.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkGL2PSExporter.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPNGWriter.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "case/errors.hpp"
#include "case/pending_file.hpp"
#include "chart_legend.hpp"
#include "offscreen_window.hpp"
#include "vtk_messages.hpp"

namespace suffuse {
namespace {

constexpr int height = 800;
constexpr int least_width = 1200;
/// Where the axes stand: left, bottom, width, height.
constexpr float left = 120.0F;
constexpr float bottom = 90.0F;
constexpr float plot_width = 720.0F;
constexpr float plot_height = 630.0F;
constexpr float margin = 30.0F;

/// White below everything, so that pictures stay readable on dark pages, and the titles: VTK's own
/// run into the labels of the ticks where a viewer has wider letters.
class Paper : public vtkContextItem {
 public:
  static Paper* New();
  float width = 0.0F;
  std::string title;
  std::string x_label;
  std::string y_label;

  bool Paint(vtkContext2D* painter) override {
    painter->GetPen()->SetLineType(vtkPen::NO_PEN);
    painter->GetBrush()->SetColorF(1.0, 1.0, 1.0);
    painter->DrawRect(0.0F, 0.0F, width, height);
    painter->GetPen()->SetLineType(vtkPen::SOLID_LINE);
    const float center = left + plot_width / 2.0F;
    write(painter, title, 24, 0.0, center, bottom + plot_height + 40.0F);
    write(painter, x_label, 21, 0.0, center, bottom - 60.0F);
    write(painter, y_label, 21, 90.0, left - 92.0F, bottom + plot_height / 2.0F);
    return true;
  }

 private:
  static void write(vtkContext2D* painter, const std::string& text, int size, double angle, float x,
                    float y) {
    vtkNew<vtkTextProperty> style;
    style->SetFontSize(size);
    style->SetOrientation(angle);
    style->SetColor(0.0, 0.0, 0.0);
    style->SetJustificationToCentered();
    style->SetVerticalJustificationToCentered();
    painter->ApplyTextProp(style);
    painter->DrawString(x, y, text.c_str());
  }
};
vtkStandardNewMacro(Paper);

vtkSmartPointer<vtkTable> table_of(const Curve& curve) {
  vtkNew<vtkDoubleArray> x;
  vtkNew<vtkDoubleArray> y;
  x->SetName("x");
  y->SetName("y");
  for (const double value : curve.x) x->InsertNextValue(value);
  for (const double value : curve.y) y->InsertNextValue(value);
  auto table = vtkSmartPointer<vtkTable>::New();
  table->AddColumn(x);
  table->AddColumn(y);
  return table;
}

void add_markers(vtkChartXY& chart, const Curve& curve, const MarkerLayer& layer) {
  const auto color = layer.white ? std::array<double, 3>{1.0, 1.0, 1.0} : curve.color;
  auto* plot = vtkPlotPoints::SafeDownCast(chart.AddPlot(vtkChart::POINTS));
  plot->SetInputData(table_of(curve), 0, 1);
  plot->SetMarkerStyle(layer.shape);
  plot->SetMarkerSize(layer.size);
  plot->SetColor(color[0], color[1], color[2]);
}

void add_curve(vtkChartXY& chart, const Curve& curve) {
  if (curve.markers) {
    for (const auto& layer : marker_layers(curve)) add_markers(chart, curve, layer);
    return;
  }
  auto* plot = chart.AddPlot(vtkChart::LINE);
  plot->SetInputData(table_of(curve), 0, 1);
  plot->SetColor(curve.color[0], curve.color[1], curve.color[2]);
  plot->SetWidth(2.0F);
  plot->GetPen()->SetLineType(vtk_line_type(curve.dash));
}

/// The axis reaches a little beyond its ticks, so that no marker is cut in half.
void set_axis(vtkAxis& axis, const std::vector<double>& ticks) {
  const double room = 0.025 * (ticks.back() - ticks.front());
  axis.SetTitle("");
  axis.GetLabelProperties()->SetFontSize(18);
  axis.GetGridPen()->SetColorF(0.88, 0.88, 0.88);
  axis.SetBehavior(vtkAxis::FIXED);
  axis.SetRange(ticks.front() - room, ticks.back() + room);
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (const double tick : ticks) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", tick);
    positions->InsertNextValue(tick);
    labels->InsertNextValue(text);
  }
  axis.SetCustomTickPositions(positions, labels);
}

std::vector<double> ticks_of(const std::vector<Curve>& curves,
                             const std::vector<double> Curve::*values) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const auto& curve : curves) {
    for (const double value : curve.*values) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  return round_ticks(low, high);
}

vtkSmartPointer<vtkChartXY> vtk_chart(const Chart& chart) {
  auto drawn = vtkSmartPointer<vtkChartXY>::New();
  drawn->SetShowLegend(false);
  drawn->SetAutoSize(false);
  drawn->SetLayoutStrategy(vtkChart::AXES_TO_RECT);
  drawn->SetSize(vtkRectf(left, bottom, plot_width, plot_height));
  for (const auto& curve : chart.curves) add_curve(*drawn, curve);
  set_axis(*drawn->GetAxis(vtkAxis::BOTTOM), ticks_of(chart.curves, &Curve::x));
  set_axis(*drawn->GetAxis(vtkAxis::LEFT), ticks_of(chart.curves, &Curve::y));
  return drawn;
}

void write_png(vtkRenderWindow& window, const std::string& path) {
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(&window);
  image->SetInputBufferTypeToRGB();
  image->ReadFrontBufferOff();
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
}

/// SVG or PDF: curves as curves, text as text.
void write_vector(vtkRenderWindow& window, const Chart& chart, const std::string& path) {
  const std::filesystem::path file(path);
  vtkNew<vtkGL2PSExporter> exporter;
  exporter->SetRenderWindow(&window);
  // The exporter puts the suffix behind the prefix itself.
  exporter->SetFilePrefix((file.parent_path() / file.stem()).string().c_str());
  if (file.extension() == ".svg") {
    exporter->SetFileFormatToSVG();
  } else {
    exporter->SetFileFormatToPDF();
  }
  exporter->SetTitle(chart.title.c_str());
  if (file.extension() == ".svg") exporter->CompressOff();
  exporter->SilentOn();      // it says that an SVG cannot hold its (white) background
  exporter->SetSortToOff();  // what is drawn later lies on top
  exporter->TextAsPathOff();
  exporter->Write();
}

}  // namespace

std::vector<double> round_ticks(double low, double high) {
  if (!(high > low)) {
    const double room = std::max(std::abs(low), 1.0) * 0.05;
    low -= room;
    high += room;
  }
  const double rough = (high - low) / 8.0;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * decade;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * decade >= rough) step = factor * decade;
  }
  // Rounding must not add a tick beyond an end that lies on one.
  const auto first = static_cast<long>(std::floor(low / step + 1e-9));
  const auto last = static_cast<long>(std::ceil(high / step - 1e-9));
  std::vector<double> ticks;
  for (long k = first; k <= last; ++k) ticks.push_back(static_cast<double>(k) * step);
  return ticks;
}

std::string picture_format(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  if (suffix == ".png" || suffix == ".svg" || suffix == ".pdf") return suffix;
  throw InputError(std::vector{InputProblem{"suffuse-post figure", "-o", "\"" + path + "\"",
                                            "a name that ends in .png, .svg or .pdf", ""}});
}

void draw_chart(const Chart& chart, const std::string& path) {
  const std::string format = picture_format(path);
  PendingFile file(path);
  const OffscreenContext context;
  constexpr float legend_left = left + plot_width + margin;
  const float legend_width = ChartLegend::width(chart.curves);
  const int width = std::max(least_width, static_cast<int>(legend_left + legend_width + margin));
  const auto window = make_offscreen_window(width, height);
  const VtkMessages messages;

  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1.0, 1.0, 1.0);
  window->AddRenderer(renderer);
  vtkNew<vtkContextActor> actor;
  vtkNew<Paper> paper;
  paper->width = static_cast<float>(width);
  paper->title = chart.title;
  paper->x_label = chart.x_label;
  paper->y_label = chart.y_label;
  actor->GetScene()->AddItem(paper);
  actor->GetScene()->AddItem(vtk_chart(chart));
  vtkNew<ChartLegend> legend;
  legend->place(legend_left, bottom + plot_height, chart.curves);
  actor->GetScene()->AddItem(legend);
  actor->GetScene()->SetRenderer(renderer);
  renderer->AddActor(actor);
  window->Render();
  if (format == ".png") {
    write_png(*window, file.temporary_path());
  } else {
    write_vector(*window, chart, file.temporary_path());
  }
  messages.throw_errors(path);
  file.commit();
}

}  // namespace suffuse

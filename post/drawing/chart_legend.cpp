#include "drawing/chart_legend.hpp"

#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkMarkerUtilities.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>

#include <algorithm>

#include "drawing/picture.hpp"
#include "drawing/type_size.hpp"

namespace suffuse {
namespace {

constexpr float max_row_height = 30.0F;
constexpr float symbol_width = 64.0F;
constexpr float symbol_gap = 12.0F;

void paint_marker(vtkContext2D* painter, const Curve& curve, float x, float y) {
  for (const auto& layer : marker_layers(curve)) {
    const Color color = layer.white ? Color{1.0, 1.0, 1.0} : curve.color;
    painter->GetPen()->SetColorF(color[0], color[1], color[2]);
    painter->GetBrush()->SetColorF(color[0], color[1], color[2]);
    painter->GetPen()->SetWidth(layer.size);
    float point[2] = {x, y};
    painter->DrawMarkers(layer.shape, false, point, 1);
  }
}

}  // namespace

vtkStandardNewMacro(ChartLegend);

int vtk_line_type(Dash dash) {
  switch (dash) {
    case Dash::dashed:
      return vtkPen::DASH_LINE;
    case Dash::dotted:
      return vtkPen::DOT_LINE;
    case Dash::dash_dot:
      return vtkPen::DASH_DOT_LINE;
    case Dash::dash_dot_dot:
      return vtkPen::DASH_DOT_DOT_LINE;
    case Dash::solid:
      break;
  }
  return vtkPen::SOLID_LINE;
}

std::vector<MarkerLayer> marker_layers(const Curve& curve) {
  constexpr float size = 13.0F;
  constexpr int circle = vtkMarkerUtilities::CIRCLE;
  if (curve.marker == Marker::target) {
    return {
        {circle, size, false}, {circle, 9.0F, true}, {circle, curve.hollow ? 3.0F : 5.0F, false}};
  }
  int shape = circle;
  if (curve.marker == Marker::square) shape = vtkMarkerUtilities::SQUARE;
  if (curve.marker == Marker::diamond) shape = vtkMarkerUtilities::DIAMOND;
  std::vector<MarkerLayer> layers{{shape, size, false}};
  if (curve.hollow) layers.push_back({shape, 7.0F, true});
  return layers;
}

void ChartLegend::place(float left, float top, float height, const std::vector<Curve>& curves) {
  left_ = left;
  top_ = top;
  std::copy_if(curves.begin(), curves.end(), std::back_inserter(rows_),
               [](const Curve& curve) { return !curve.label.empty(); });
  row_height_ = std::min(max_row_height, height / static_cast<float>(rows_.size()));
}

float ChartLegend::width(const std::vector<Curve>& curves) {
  std::size_t letters = 0;
  for (const auto& curve : curves) letters = std::max(letters, curve.label.size());
  return symbol_width + symbol_gap + letter_width * static_cast<float>(letters);
}

bool ChartLegend::Paint(vtkContext2D* painter) {
  float y = top_ - row_height_ / 2.0F;
  for (const auto& curve : rows_) {
    if (curve.is_band()) {
      painter->GetPen()->SetLineType(vtkPen::NO_PEN);
      painter->GetBrush()->SetColorF(curve.color[0], curve.color[1], curve.color[2]);
      painter->DrawRect(left_, y - 0.3F * row_height_, symbol_width, 0.6F * row_height_);
    }
    if (curve.has_line()) {
      painter->GetPen()->SetLineType(vtk_line_type(curve.dash));
      painter->GetPen()->SetWidth(curve.width);
      painter->GetPen()->SetColorF(curve.color[0], curve.color[1], curve.color[2]);
      painter->DrawLine(left_, y, left_ + symbol_width, y);
    }
    if (curve.markers) paint_marker(painter, curve, left_ + symbol_width / 2.0F, y);
    paint_text(*painter, curve.label, std::min(font_size, static_cast<int>(0.8F * row_height_)),
               left_ + symbol_width + symbol_gap, y, Anchor::left);
    y -= row_height_;
  }
  painter->GetPen()->SetLineType(vtkPen::SOLID_LINE);
  return true;
}

}  // namespace suffuse

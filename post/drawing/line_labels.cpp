#include "drawing/line_labels.hpp"

#include <vtkBrush.h>
#include <vtkPen.h>

#include <algorithm>
#include <cmath>

#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"

namespace suffuse {
namespace {

constexpr int label_size = 16;
constexpr double label_letter_width = 9.0;

}  // namespace

void paint_polyline(vtkContext2D& painter, const ModelView& view, const Polyline& line,
                    const Color& color, float width) {
  std::vector<float> points;
  for (const Vector<2>& x : line) {
    const Vector<2> at = view.pixel(x);
    points.push_back(static_cast<float>(at[0]));
    points.push_back(static_cast<float>(at[1]));
  }
  painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
  painter.GetPen()->SetColorF(color[0], color[1], color[2]);
  painter.GetPen()->SetWidth(width);
  painter.DrawPoly(points.data(), static_cast<int>(line.size()));
}

void paint_polylines(vtkContext2D& painter, const ModelView& view,
                     const std::vector<Polyline>& lines, const Color& color, float width) {
  for (const Polyline& line : lines) paint_polyline(painter, view, line, color, width);
}

void paint_edged_polylines(vtkContext2D& painter, const ModelView& view,
                           const std::vector<Polyline>& lines, const Color& color,
                           const Color& edge, float width) {
  paint_polylines(painter, view, lines, edge, width + 2.0F);
  paint_polylines(painter, view, lines, color, width);
}

bool LineLabels::is_free(const Box& box) const {
  return std::ranges::none_of(taken_, [&](const Box& other) {
    const Vector<2> apart = (box.middle - other.middle).cwiseAbs() - (box.half + other.half);
    return apart.maxCoeff() < 0.0;
  });
}

void LineLabels::avoid(const std::vector<Polyline>& lines) {
  constexpr double apart = 8.0;  // pixels
  for (const Polyline& line : lines) {
    const double count = std::ceil(view_.scale() * length(line) / apart);
    for (double k = 0.0; k <= count; ++k) {
      taken_.push_back({view_.pixel(place_on(line, k / std::max(1.0, count))), {2.0, 2.0}});
    }
  }
}

void LineLabels::paint(vtkContext2D& painter, const std::vector<Polyline>& lines,
                       const std::string& text) {
  const Vector<2> half(0.5 * label_letter_width * static_cast<double>(text.size()) + 3.0, 10.0);
  const auto longest = std::ranges::max_element(lines, {}, length);
  if (longest == lines.end() || view_.scale() * length(*longest) < 3.0 * half[0]) return;
  for (const double share : {0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8}) {
    const Box box{view_.pixel(place_on(*longest, share)), half};
    if (!view_.shows(box.middle, half) || !is_free(box)) continue;
    painter.GetPen()->SetLineType(vtkPen::NO_PEN);
    painter.GetBrush()->SetColorF(1.0, 1.0, 1.0);
    const Vector<2> corner = box.middle - half;
    painter.DrawRect(static_cast<float>(corner[0]), static_cast<float>(corner[1]),
                     static_cast<float>(2.0 * half[0]), static_cast<float>(2.0 * half[1]));
    painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
    paint_text(painter, text, label_size, static_cast<float>(box.middle[0]),
               static_cast<float>(box.middle[1]));
    taken_.push_back(box);
    return;
  }
}

std::vector<Polyline> level_lines(const ContourField& field, double level) {
  double low = HUGE_VAL;
  double high = -HUGE_VAL;
  for (const double value : field.at_nodes) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) return {};
  return contour_lines(field.mesh, field.at_nodes, level + 1e-6 * (level - 0.5 * (low + high)));
}

void paint_contours(vtkContext2D& painter, const ModelView& view, const ContourField& field,
                    const LineStyle& style, LineLabels& labels) {
  std::vector<std::vector<Polyline>> lines;
  for (const double level : field.levels) {
    lines.push_back(level_lines(field, level));
    paint_polylines(painter, view, lines.back(), style.color, style.width);
  }
  for (std::size_t k = 0; k < lines.size(); ++k) {
    labels.paint(painter, lines[k], digits_text(field.levels[k], 4));
  }
}

}  // namespace suffuse

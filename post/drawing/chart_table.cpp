#include "drawing/chart_table.hpp"

#include <vtkPen.h>

#include <algorithm>

#include "drawing/picture.hpp"
#include "drawing/type_size.hpp"

namespace suffuse {
namespace {

constexpr float row_height = 28.0F;
constexpr float room_above = 24.0F;
constexpr float column_gap = 24.0F;

std::vector<float> column_widths(const ChartTable& table) {
  std::vector<float> widths;
  for (const auto& row : table) {
    widths.resize(std::max(widths.size(), row.size()), 0.0F);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const float width = letter_width * static_cast<float>(row[i].size()) + column_gap;
      widths[i] = std::max(widths[i], width);
    }
  }
  return widths;
}

}  // namespace

float table_width(const ChartTable& table) {
  float width = 0.0F;
  for (const float column : column_widths(table)) width += column;
  return std::max(0.0F, width - column_gap);
}

float table_height(const ChartTable& table) {
  return table.empty() ? 0.0F : room_above + row_height * static_cast<float>(table.size());
}

void paint_table(vtkContext2D& painter, const ChartTable& table, float left, float top) {
  const std::vector<float> widths = column_widths(table);
  float y = top - room_above - row_height / 2.0F;
  for (const auto& row : table) {
    float x = left;
    for (std::size_t i = 0; i < row.size(); ++i) {
      paint_text(painter, row[i], font_size, x, y, Anchor::left);
      x += widths[i];
    }
    if (&row == table.data()) {
      const float line = y - row_height / 2.0F;
      painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
      painter.GetPen()->SetWidth(1.0F);
      painter.GetPen()->SetColorF(0.0, 0.0, 0.0);
      painter.DrawLine(left, line, left + table_width(table), line);
    }
    y -= row_height;
  }
}

}  // namespace suffuse

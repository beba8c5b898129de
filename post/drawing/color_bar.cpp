#include "drawing/color_bar.hpp"

#include <vtkBrush.h>
#include <vtkPen.h>

#include <algorithm>
#include <cmath>

#include "drawing/picture.hpp"
#include "drawing/type_size.hpp"

namespace suffuse {
namespace {

using Layout = PictureLayout;
constexpr float bar_tick = 8.0F;
constexpr float label_letter = 10.5F;
/// Least distance between the texts of two marks, pixels.
constexpr float between_marks = 12.0F;

float longest(const ColorBar& bar) {
  std::size_t letters = 0;
  for (const BarMark& mark : bar.marks) letters = std::max(letters, mark.text.size());
  return letter_width * static_cast<float>(letters);
}

/// The marks that do not touch one another; `length` of the bar in pixels.
std::vector<BarMark> marks_apart(const ColorBar& bar, double length, bool lies) {
  std::vector<BarMark> kept;
  const auto half = [&](const BarMark& mark) {
    return lies ? 0.5 * letter_width * static_cast<double>(mark.text.size()) : 6.0;
  };
  for (const BarMark& mark : bar.marks) {
    const bool is_free = std::ranges::all_of(kept, [&](const BarMark& other) {
      return length * std::abs(mark.share - other.share) >=
             half(mark) + half(other) + between_marks;
    });
    if (is_free) kept.push_back(mark);
  }
  return kept;
}

void paint_lying(vtkContext2D& painter, const ColorBar& bar, const ModelView& view) {
  const float bottom = view.bottom() - axes_bottom - Layout::bar_width;
  for (const BarMark& mark : marks_apart(bar, view.width(), true)) {
    const float x = view.left() + view.width() * static_cast<float>(mark.share);
    painter.DrawLine(x, bottom, x, bottom - bar_tick);
    paint_text(painter, mark.text, font_size, x, bottom - 22.0F);
  }
  std::string label = bar.label;
  for (const std::string& note : bar.notes) label += "; " + note;
  paint_text(painter, label, 20, view.left() + view.width() / 2.0F, bottom - 50.0F);
}

void paint_upright(vtkContext2D& painter, const ColorBar& bar, const ModelView& view, float left) {
  const float right = left + Layout::bar_width;
  for (const BarMark& mark : marks_apart(bar, view.height(), false)) {
    const float y = view.bottom() + view.height() * static_cast<float>(mark.share);
    painter.DrawLine(right, y, right + bar_tick, y);
    paint_text(painter, mark.text, font_size, right + 14.0F, y, Anchor::left);
  }
  paint_text(painter, bar.label, 20, right + 34.0F + longest(bar),
             view.bottom() + view.height() / 2.0F, Anchor::center, 90.0);
  float y = view.bottom() - 30.0F;
  for (const std::string& note : bar.notes) {
    paint_text(painter, note, font_size, left, y, Anchor::left);
    y -= 24.0F;
  }
}

}  // namespace

bool has_lying_bar(const ModelView& view) {
  return view.height() < Layout::min_bar_height;
}

float room_below(const ModelView& view) {
  return has_lying_bar(view) ? Layout::bar_width + 72.0F : 0.0F;
}

float room_at_right(const ModelView& view, const ColorBar& bar) {
  if (has_lying_bar(view)) return 0.5F * longest(bar);
  float width = Layout::bar_width + 34.0F + longest(bar) + 20.0F;
  for (const std::string& note : bar.notes) {
    width = std::max(width, label_letter * static_cast<float>(note.size()));
  }
  return width;
}

void paint_color_bar(vtkContext2D& painter, const ColorBar& bar, const ModelView& view, float gap) {
  const bool lies = has_lying_bar(view);
  const float left = lies ? view.left() : view.left() + view.width() + gap;
  const float bottom = lies ? view.bottom() - axes_bottom - Layout::bar_width : view.bottom();
  const float step = (lies ? view.width() : view.height()) /
                     static_cast<float>(std::max<std::size_t>(1, bar.bands.size()));
  painter.GetPen()->SetLineType(bar.framed ? vtkPen::SOLID_LINE : vtkPen::NO_PEN);
  painter.GetPen()->SetColorF(0.0, 0.0, 0.0);
  painter.GetPen()->SetWidth(1.0F);
  float along = 0.0F;
  for (const Color& color : bar.bands) {
    painter.GetBrush()->SetColorF(color[0], color[1], color[2]);
    if (lies) {
      painter.DrawRect(left + along, bottom, step, Layout::bar_width);
    } else {
      painter.DrawRect(left, bottom + along, Layout::bar_width, step);
    }
    along += step;
  }
  painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
  painter.GetPen()->SetWidth(1.5F);
  if (lies) {
    paint_lying(painter, bar, view);
  } else {
    paint_upright(painter, bar, view, left);
  }
}

}  // namespace suffuse

#include "studies/stress_chart.hpp"

#include <vtkBrush.h>
#include <vtkPen.h>

#include <algorithm>
#include <array>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "drawing/chart.hpp"
#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"
#include "studies/text_table.hpp"

namespace suffuse {
namespace {

/// A part of a bar: the runs with one verdict.
struct Verdict {
  const char* name;
  int SweepCount::*count;
  unsigned char grey;
  bool white_text;
};
constexpr std::array<Verdict, 3> verdicts{{{"pass", &SweepCount::pass, 215, false},
                                           {"refused", &SweepCount::refused, 140, false},
                                           {"failed", &SweepCount::failed, 0, true}}};

constexpr float left_room = 190.0F;
constexpr float plot_width = 860.0F;
constexpr float margin = 40.0F;
constexpr float row_height = 36.0F;
constexpr float bar_height = 26.0F;
constexpr float bottom_room = 90.0F;
constexpr float top_room = 70.0F;
/// With size 16 digits fill their textures, and VTK repeats their top row below them.
constexpr int text_size = 18;

void paint_box(vtkContext2D& painter, unsigned char grey, float x, float y, float width,
               float height) {
  painter.GetBrush()->SetColor(grey, grey, grey, 255);
  painter.GetPen()->SetColor(0, 0, 0, 255);
  painter.GetPen()->SetWidth(1.0F);
  painter.DrawRect(x, y, width, height);
}

/// A part of a bar, with its number where the number fits.
void paint_part(vtkContext2D& painter, const Verdict& verdict, int count, float x, float y,
                float width) {
  paint_box(painter, verdict.grey, x, y, width, bar_height);
  const std::string text = std::to_string(count);
  if (verdict.white_text || width < 12.0F * static_cast<float>(text.size()) + 6.0F) return;
  paint_text(painter, text, text_size, x + 0.5F * width, y + 0.5F * bar_height);
}

void paint_axis(vtkContext2D& painter, const std::vector<double>& ticks, float scale, float top) {
  for (const double tick : ticks) {
    const float x = left_room + scale * static_cast<float>(tick);
    painter.GetPen()->SetColor(224, 224, 224, 255);
    painter.DrawLine(x, bottom_room, x, top);
    paint_text(painter, tick_text(tick), text_size, x, bottom_room - 18.0F);
  }
  paint_text(painter, "runs", text_size, left_room + 0.5F * plot_width, bottom_room - 48.0F);
}

void paint_legend(vtkContext2D& painter, float y) {
  float x = left_room;
  for (const Verdict& verdict : verdicts) {
    paint_box(painter, verdict.grey, x, y - 0.5F * bar_height, 40.0F, bar_height);
    paint_text(painter, verdict.name, text_size, x + 52.0F, y, Anchor::left);
    x += 190.0F;
  }
}

}  // namespace

std::vector<SweepCount> read_sweep_counts(const std::string& path) {
  const TextTable table = read_text_table(path);
  const std::size_t sweep = table.column("sweep");
  const std::size_t verdict = table.column("verdict");
  std::vector<SweepCount> result;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    const auto known = std::ranges::find(verdicts, row[verdict], &Verdict::name);
    if (known == verdicts.end()) {
      const std::vector<std::string> all{"pass", "refused", "failed"};
      throw InputError(
          std::vector<InputProblem>{{table.place(i), "verdict", '"' + row[verdict] + '"',
                                     quoted_list(all), closest_name(row[verdict], all)}});
    }
    auto own = std::ranges::find(result, row[sweep], &SweepCount::sweep);
    if (own == result.end()) own = result.insert(result.end(), SweepCount{row[sweep]});
    ++((*own).*(known->count));
  }
  return result;
}

void draw_stress_chart(const std::vector<SweepCount>& sweeps, const std::string& path) {
  int longest = 1;
  for (const SweepCount& sweep : sweeps) longest = std::max(longest, sweep.runs());
  const std::vector<double> ticks = round_ticks(0.0, longest);
  const float scale = plot_width / static_cast<float>(ticks.back());
  const float top = bottom_room + row_height * static_cast<float>(sweeps.size());
  const auto paint = [=](vtkContext2D& painter) {
    paint_axis(painter, ticks, scale, top);
    paint_legend(painter, top + 0.5F * top_room);
    float y = top - 0.5F * (row_height + bar_height);
    for (const SweepCount& sweep : sweeps) {
      paint_text(painter, sweep.sweep, text_size, left_room - 12.0F, y + 0.5F * bar_height,
                 Anchor::right);
      float x = left_room;
      for (const Verdict& verdict : verdicts) {
        const int count = sweep.*(verdict.count);
        if (count == 0) continue;
        const float width = scale * static_cast<float>(count);
        paint_part(painter, verdict, count, x, y, width);
        x += width;
      }
      if (sweep.failed > 0) {
        paint_text(painter, std::to_string(sweep.failed) + " failed", text_size, x + 8.0F,
                   y + 0.5F * bar_height, Anchor::left);
      }
      y -= row_height;
    }
  };
  draw_picture(static_cast<int>(left_room + plot_width + margin), static_cast<int>(top + top_room),
               "stress study", path, [&](vtkContextScene& scene) { add_painted(scene, paint); });
}

}  // namespace suffuse

#include "figures/field_scale.hpp"

#include <vtkBrush.h>
#include <vtkPen.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "drawing/color_map.hpp"
#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"

namespace suffuse {
namespace {

constexpr int bar_bands = 256;
/// The ends of a range are zero if they are less than this share of the range.
constexpr double negligible_end = 1e-9;
constexpr double percentile = 0.01;

/// A value on the scale on which colours are evenly spaced.
double even(double value, bool logarithmic) {
  return logarithmic ? std::log10(value) : value;
}

/// The smallest value below which lies at least this share of the weights; values ascend.
double quantile(const std::vector<WeightedValue>& values, double share) {
  double all = 0.0;
  for (const auto& v : values) all += v.weight;
  double below = 0.0;
  for (const auto& v : values) {
    below += v.weight;
    if (below >= share * all) return v.value;
  }
  return values.back().value;
}

/// Leaves out the outermost values where they are far outside.
void leave_out_extremes(FieldScale& scale, const std::vector<WeightedValue>& values,
                        const std::string& shares) {
  const bool logarithmic = scale.logarithmic;
  const auto [least, largest] = scale.range;
  const std::array<double, 2> inner{quantile(values, percentile),
                                    quantile(values, 1.0 - percentile)};
  const double far = 0.5 * (even(inner[1], logarithmic) - even(inner[0], logarithmic));
  if (!(far > 0.0)) return;
  scale.exceeds_low = even(inner[0], logarithmic) - even(least, logarithmic) > far;
  scale.exceeds_high = even(largest, logarithmic) - even(inner[1], logarithmic) > far;
  if (scale.exceeds_low) scale.range[0] = inner[0];
  if (scale.exceeds_high) scale.range[1] = inner[1];
  if (!scale.exceeds_low && !scale.exceeds_high) return;
  const bool both = scale.exceeds_low && scale.exceeds_high;
  scale.notes.push_back((both ? "98 % of the " : "99 % of the ") + shares);
  if (scale.exceeds_low) scale.notes.push_back("least " + digits_text(least, 4));
  if (scale.exceeds_high) scale.notes.push_back("largest " + digits_text(largest, 4));
}

/// Digits that tell places on a bar apart; at least `least`.
int digits_of(const FieldScale& scale, int least) {
  const double range = scale.range[1] - scale.range[0];
  if (scale.uniform || scale.logarithmic || !(range > 0.0)) return least;
  const double size = std::max(std::abs(scale.range[0]), std::abs(scale.range[1]));
  return std::max(least, 3 + static_cast<int>(std::ceil(std::log10(size / range))));
}

/// The label of an end of the range: four digits or what tells it from ticks; zero if the value is
/// round-off.
std::string end_text(double value, const FieldScale& scale) {
  const double range = scale.range[1] - scale.range[0];
  if (!scale.logarithmic && std::abs(value) < negligible_end * range) value = 0.0;
  return digits_text(value, digits_of(scale, 4));
}

}  // namespace

double FieldScale::fraction(double value) const {
  if (uniform) return 0.5;
  const double low = even(range[0], logarithmic);
  return (even(value, logarithmic) - low) / (even(range[1], logarithmic) - low);
}

Color FieldScale::color(double value) const {
  for (const auto& kind : kinds) {
    if (std::abs(value - kind.value) < 0.5) return kind.color;
  }
  if (!kinds.empty() || std::isnan(value)) return no_value;
  if (logarithmic && !(value > 0.0)) return no_value;
  return viridis(fraction(value));
}

std::vector<double> FieldScale::levels() const {
  if (uniform || !kinds.empty()) return {};
  std::vector<double> levels =
      logarithmic ? logarithmic_ticks(range[0], range[1]).ticks : round_ticks(range[0], range[1]);
  std::erase_if(levels, [&](double level) { return level < range[0] || level > range[1]; });
  return levels;
}

std::string FieldScale::level_text(double level) const {
  return logarithmic ? logarithmic_tick_text(level) : digits_text(level, digits_of(*this, 6));
}

FieldScale value_scale(std::vector<WeightedValue> values, const ScaleRequest& request) {
  FieldScale scale;
  scale.logarithmic = request.logarithmic;
  const auto all = values.size();
  const bool infinite =
      std::ranges::any_of(values, [](const WeightedValue& v) { return v.value == HUGE_VAL; });
  std::erase_if(values, [&](const WeightedValue& v) {
    return !std::isfinite(v.value) || (request.logarithmic && !(v.value > 0.0));
  });
  std::ranges::sort(values, {}, &WeightedValue::value);
  if (request.logarithmic && values.size() < all) scale.notes.emplace_back("grey: not above zero");
  if (request.range) {
    scale.range = *request.range;
    scale.exceeds_low = !values.empty() && values.front().value < scale.range[0];
    scale.exceeds_high = infinite || (!values.empty() && values.back().value > scale.range[1]);
    return scale;
  }
  if (values.empty()) {
    if (request.logarithmic) scale.range[0] = 0.1;
    return scale;
  }
  scale.range = {values.front().value, values.back().value};
  const double size = std::max(std::abs(scale.range[0]), std::abs(scale.range[1]));
  if (size <= request.round_off) scale.range = {0.0, 0.0};
  if (is_one_value(scale.range[0], scale.range[1])) {
    scale.uniform = true;
    scale.logarithmic = false;
    return scale;
  }
  leave_out_extremes(scale, values, request.shares);
  scale.exceeds_high = scale.exceeds_high || infinite;
  return scale;
}

ColorBar bar_of(const FieldScale& scale, const std::string& label) {
  ColorBar bar{{}, false, {}, label, scale.notes};
  const int bands = scale.uniform ? 1 : bar_bands;
  for (int band = 0; band < bands; ++band) bar.bands.push_back(viridis((band + 0.5) / bands));
  const auto mark = [&](double value, const std::string& text) {
    bar.marks.push_back({scale.fraction(value), text});
  };
  const auto [low, high] = scale.range;
  mark(low, (scale.exceeds_low ? "<= " : "") + end_text(low, scale));
  if (!scale.uniform) mark(high, (scale.exceeds_high ? ">= " : "") + end_text(high, scale));
  for (const double level : scale.levels()) mark(level, scale.level_text(level));
  return bar;
}

float kinds_width(const FieldScale& scale, const std::string& label) {
  std::size_t letters = label.size();
  for (const auto& kind : scale.kinds) letters = std::max(letters, kind.name.size());
  return 60.0F + 11.0F * static_cast<float>(letters);
}

float kinds_height(const FieldScale& scale) {
  return 36.0F + 34.0F * static_cast<float>(scale.kinds.size());
}

void paint_kinds(vtkContext2D& painter, const FieldScale& scale, const std::string& label,
                 float left, float top) {
  paint_text(painter, label, 20, left, top - 12.0F, Anchor::left);
  float y = top - 48.0F;
  for (const auto& kind : scale.kinds) {
    painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
    painter.GetPen()->SetColorF(0.0, 0.0, 0.0);
    painter.GetPen()->SetWidth(1.0F);
    painter.GetBrush()->SetColorF(kind.color[0], kind.color[1], kind.color[2]);
    painter.DrawRect(left, y - 11.0F, 30.0F, 22.0F);
    paint_text(painter, kind.name, 18, left + 42.0F, y, Anchor::left);
    y -= 34.0F;
  }
}

}  // namespace suffuse

#include "figures/seepage_map.hpp"

#include <vtkBrush.h>
#include <vtkNew.h>
#include <vtkPen.h>

#include <algorithm>
#include <cmath>

#include "case/errors.hpp"
#include "drawing/chart_legend.hpp"
#include "drawing/color_map.hpp"
#include "drawing/colored_triangles.hpp"
#include "drawing/contours.hpp"
#include "drawing/model_view.hpp"
#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"
#include "physics/head.hpp"
#include "values/fields.hpp"

namespace suffuse {
namespace {

using Layout = PictureLayout;
constexpr Color black{0.0, 0.0, 0.0};
constexpr Color white{1.0, 1.0, 1.0};
constexpr Color water_blue{0.0, 0.27, 0.53};
constexpr Color water_tint{0.91, 0.96, 1.0};
constexpr float top_room = 100.0F;
constexpr float bar_room = 190.0F;
constexpr float legend_row = 30.0F;
constexpr float line_width = 1.2F;
constexpr float phreatic_width = 3.5F;
constexpr int label_size = 16;
constexpr double letter_width = 9.0;
/// Of water beside an upright boundary, as a share of the model's larger extent.
constexpr double water_breadth = 0.08;

/// What all of a picture is painted with.
struct Sheet {
  const SeepageMap& map;
  ModelView view;
  std::vector<double> levels;

  /// The colour between two levels.
  [[nodiscard]] Color band_color(std::size_t band) const {
    const double fraction = levels.size() > 2
                                ? static_cast<double>(band) / static_cast<double>(levels.size() - 2)
                                : 0.5;
    // Wet soil is dark.
    return viridis(map.saturation.empty() ? fraction : 1.0 - fraction);
  }
  [[nodiscard]] std::size_t band_of(double value) const {
    const auto above = std::ranges::upper_bound(levels, value) - levels.begin();
    return static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(above - 1, 0, std::ssize(levels) - 2));
  }
};

void add_polygon(ColoredTriangles& triangles, const Polyline& polygon, const Color& color) {
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    triangles.add({polygon[0], polygon[i], polygon[i + 1]}, {color, color, color});
  }
}

void paint_bands(vtkContext2D& painter, const Sheet& sheet) {
  ColoredTriangles triangles;
  const Mesh<2>& mesh = sheet.map.mesh;
  for (int e = 0; e < mesh.element_count(); ++e) {
    std::array<Vector<2>, 3> corners;
    std::array<double, 3> values{};
    for (int a = 0; a < 3; ++a) {
      corners.at(a) = sheet.view.pixel(mesh.nodes[mesh.elements[e][a]]);
      values.at(a) = sheet.map.head[mesh.elements[e][a]];
    }
    if (!sheet.map.saturation.empty()) {
      const Color color = sheet.band_color(sheet.band_of(sheet.map.saturation[e]));
      triangles.add(corners, {color, color, color});
      continue;
    }
    const std::size_t first = sheet.band_of(std::ranges::min(values));
    const std::size_t last = sheet.band_of(std::ranges::max(values));
    for (std::size_t band = first; band <= last; ++band) {
      // The outer bands have no outer ends: round-off leaves no holes.
      const double low = band == first ? -HUGE_VAL : sheet.levels[band];
      const double high = band == last ? HUGE_VAL : sheet.levels[band + 1];
      const Polyline part = first == last ? Polyline(corners.begin(), corners.end())
                                          : band_in_triangle(corners, values, low, high);
      add_polygon(triangles, part, sheet.band_color(band));
    }
  }
  triangles.paint(painter);
}

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

/// A rectangle that holds a label, pixels.
struct LabelBox {
  Vector<2> middle;
  Vector<2> half;

  [[nodiscard]] bool overlaps(const LabelBox& other) const {
    const Vector<2> apart = (middle - other.middle).cwiseAbs() - (half + other.half);
    return apart.maxCoeff() < 0.0;
  }
};

/// On the longest of the lines, where it hides no other label and lies on the model.
void paint_level_label(vtkContext2D& painter, const Sheet& sheet,
                       const std::vector<Polyline>& lines, double level,
                       std::vector<LabelBox>& taken) {
  const std::string text = tick_text(level);
  const Vector<2> half(0.5 * letter_width * static_cast<double>(text.size()) + 3.0, 10.0);
  const auto longest = std::ranges::max_element(lines, {}, length);
  if (longest == lines.end() || sheet.view.scale() * length(*longest) < 3.0 * half[0]) return;
  for (const double share : {0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8}) {
    const LabelBox box{sheet.view.pixel(place_on(*longest, share)), half};
    const bool hides =
        std::ranges::any_of(taken, [&](const LabelBox& other) { return box.overlaps(other); });
    if (hides) continue;
    painter.GetPen()->SetLineType(vtkPen::NO_PEN);
    painter.GetBrush()->SetColorF(1.0, 1.0, 1.0);
    const Vector<2> corner = box.middle - half;
    painter.DrawRect(static_cast<float>(corner[0]), static_cast<float>(corner[1]),
                     static_cast<float>(2.0 * half[0]), static_cast<float>(2.0 * half[1]));
    painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
    paint_text(painter, text, label_size, static_cast<float>(box.middle[0]),
               static_cast<float>(box.middle[1]));
    taken.push_back(box);
    return;
  }
}

/// `hidden`: lines that are drawn over these, which labels keep clear of.
void paint_equipotentials(vtkContext2D& painter, const Sheet& sheet,
                          const std::vector<Polyline>& hidden) {
  if (!sheet.map.saturation.empty()) return;
  std::vector<std::vector<Polyline>> lines;
  const double middle = 0.5 * (sheet.levels.front() + sheet.levels.back());
  for (std::size_t k = 1; k + 1 < sheet.levels.size(); ++k) {
    // Boundaries often have a round head, up to round-off. A little further from the middle, the
    // line does not run along them.
    const double level = sheet.levels[k] + 1e-6 * (sheet.levels[k] - middle);
    lines.push_back(contour_lines(sheet.map.mesh, sheet.map.head, level));
    for (const Polyline& line : lines.back()) {
      paint_polyline(painter, sheet.view, line, black, line_width);
    }
  }
  std::vector<LabelBox> taken;
  constexpr double apart = 8.0;  // pixels
  for (const Polyline& line : hidden) {
    const double count = std::ceil(sheet.view.scale() * length(line) / apart);
    for (double k = 0.0; k <= count; ++k) {
      taken.push_back({sheet.view.pixel(place_on(line, k / count)), {2.0, 2.0}});
    }
  }
  for (std::size_t k = 0; k < lines.size(); ++k) {
    paint_level_label(painter, sheet, lines[k], sheet.levels[k + 1], taken);
  }
}

/// Where p = 0. Faces through which water seeps out have that pressure up to round-off: a little
/// less is taken, so that the line does not run along them.
std::vector<Polyline> phreatic_lines(const SeepageMap& map) {
  if (map.pressure.empty()) return {};
  const auto [low, high] = std::ranges::minmax(map.pressure);
  return contour_lines(map.mesh, map.pressure, -1e-3 * (high - low));
}

void paint_outside_water(vtkContext2D& painter, const Sheet& sheet) {
  ColoredTriangles bodies;
  for (const OutsideWater& water : sheet.map.water) {
    for (const auto& corners : water.body) {
      Polyline polygon;
      for (const Vector<2>& x : corners) polygon.push_back(sheet.view.pixel(x));
      add_polygon(bodies, polygon, water_tint);
    }
  }
  if (!sheet.map.water.empty()) bodies.paint(painter);
  for (const OutsideWater& water : sheet.map.water) {
    paint_polyline(painter, sheet.view, {water.level[0], water.level[1]}, water_blue, 2.5F);
    // The sign of a water level: a triangle that stands on it, and the head over it.
    const Vector<2> at = sheet.view.pixel(0.5 * (water.level[0] + water.level[1]));
    const auto x = static_cast<float>(at[0]);
    const auto y = static_cast<float>(at[1]);
    std::array<float, 3> xs{x, x - 8.0F, x + 8.0F};
    std::array<float, 3> ys{y + 1.0F, y + 14.0F, y + 14.0F};
    painter.GetBrush()->SetColorF(1.0, 1.0, 1.0);
    painter.GetPen()->SetWidth(1.5F);
    painter.DrawPolygon(xs.data(), ys.data(), 3);
    paint_text(painter, tick_text(water.head) + " m", 18, x, y + 27.0F);
  }
}

void paint_bar(vtkContext2D& painter, const Sheet& sheet, float left, float bottom, float height) {
  const std::size_t bands = sheet.levels.size() - 1;
  const float step = height / static_cast<float>(bands);
  painter.GetPen()->SetColorF(0.0, 0.0, 0.0);
  painter.GetPen()->SetWidth(1.0F);
  for (std::size_t band = 0; band < bands; ++band) {
    const Color color = sheet.band_color(band);
    painter.GetBrush()->SetColorF(color[0], color[1], color[2]);
    painter.DrawRect(left, bottom + static_cast<float>(band) * step, Layout::bar_width, step);
  }
  std::size_t letters = 0;
  for (std::size_t k = 0; k <= bands; ++k) {
    const float y = bottom + static_cast<float>(k) * step;
    const std::string text = tick_text(sheet.levels[k]);
    letters = std::max(letters, text.size());
    painter.DrawLine(left + Layout::bar_width, y, left + Layout::bar_width + 8.0F, y);
    paint_text(painter, text, 18, left + Layout::bar_width + 14.0F, y, Anchor::left);
  }
  paint_text(painter, sheet.map.label, 20,
             left + Layout::bar_width + 50.0F + 10.5F * static_cast<float>(letters),
             bottom + height / 2.0F, Anchor::center, 90.0);
}

std::vector<Curve> legend_rows(const SeepageMap& map, bool has_equipotentials,
                               bool has_phreatic_line) {
  std::vector<Curve> rows;
  const auto add = [&](const char* label, const Color& color, float width) {
    Curve row;
    row.label = label;
    row.color = color;
    row.width = width;
    rows.push_back(row);
  };
  if (has_equipotentials) add("equipotential, head in m", black, line_width);
  if (has_phreatic_line) add("phreatic line, p = 0", water_blue, phreatic_width);
  if (!map.water.empty()) add("water level outside, with its head", water_blue, 2.5F);
  return rows;
}

/// The smallest box around the model and the water outside.
ModelView view_of(const SeepageMap& map, float bottom) {
  Vector<2> low = map.mesh.nodes.front();
  Vector<2> high = low;
  const auto include = [&](const Vector<2>& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  };
  for (const Vector<2>& node : map.mesh.nodes) include(node);
  for (const OutsideWater& water : map.water) {
    for (const auto& corners : water.body) std::ranges::for_each(corners, include);
    std::ranges::for_each(water.level, include);
  }
  std::ranges::for_each(map.covered_places, include);
  return {low, high, axes_left, bottom, Layout::max_width, Layout::max_height};
}

/// What both maps share.
SeepageMap map_of(const ResultsReader& run, std::size_t index, const std::optional<double>& time) {
  const Scene& scene = run.scene().scene;
  SeepageMap map;
  map.title = snapshot_title(run, index, time);
  map.mesh = run.mesh();
  map.pressure = run.field(index, "node", "pressure").values;
  const double weight = unit_weight(scene.liquid.density, scene.gravity);
  Vector<2> low = map.mesh.nodes.front();
  Vector<2> high = low;
  for (int i = 0; i < map.mesh.node_count(); ++i) {
    const Vector<2>& x = map.mesh.nodes[i];
    map.head.push_back(map.pressure[i] / weight + height(x, scene.gravity));
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double breadth = water_breadth * (high - low).maxCoeff();
  map.water = outside_water(map.mesh, scene, run.times()[index], breadth);
  if (!has_gravity(scene.gravity)) map.pressure.clear();
  return map;
}

}  // namespace

SeepageMap head_map(const ResultsReader& run, const std::optional<double>& time) {
  SeepageMap map = map_of(run, snapshot_at(run, time), time);
  map.label = "head h (m)";
  return map;
}

SeepageMap saturation_map(const ResultsReader& run, const std::optional<double>& time) {
  const std::size_t index = snapshot_at(run, time);
  const auto names = run.field_names(index, "cell");
  if (std::ranges::find(names, "saturation") == names.end()) {
    throw InputError(std::vector{InputProblem{"suffuse-post figure saturation", "RESULTS",
                                              run.folder() + ", in which every soil is saturated",
                                              "a run with a soil that has a retention law", ""}});
  }
  SeepageMap map = map_of(run, index, time);
  map.saturation = run.field(index, "cell", "saturation").values;
  map.label = "saturation S (-)";
  return map;
}

std::vector<double> band_levels(double low, double high) {
  // Water at rest has one head, up to round-off.
  const double size = std::max({std::abs(low), std::abs(high), 1e-9});
  if (high - low <= 1e-9 * size) {
    const double room = 0.05 * size;
    return {low - room, high + room};
  }
  std::vector<double> levels = round_ticks(low, high);
  if (levels.size() < 8) {
    std::vector<double> finer;
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
      finer.insert(finer.end(), {levels[k], 0.5 * (levels[k] + levels[k + 1])});
    }
    finer.push_back(levels.back());
    levels = std::move(finer);
  }
  // Bands in which no value lies.
  const double slack = 1e-9 * (high - low);
  while (levels.size() > 2 && levels[1] <= low + slack) levels.erase(levels.begin());
  while (levels.size() > 2 && levels[levels.size() - 2] >= high - slack) levels.pop_back();
  return levels;
}

void align_maps(std::vector<SeepageMap>& maps) {
  std::array<double, 2> heads{HUGE_VAL, -HUGE_VAL};
  std::vector<Vector<2>> places;
  for (const SeepageMap& map : maps) {
    const auto [low, high] = std::ranges::minmax(map.head);
    heads = {std::min(heads[0], low), std::max(heads[1], high)};
    for (const OutsideWater& water : map.water) {
      for (const auto& corners : water.body) {
        places.insert(places.end(), corners.begin(), corners.end());
      }
      places.insert(places.end(), water.level.begin(), water.level.end());
    }
  }
  for (SeepageMap& map : maps) {
    map.covered_heads = heads;
    map.covered_places = places;
  }
}

void draw_seepage_map(const SeepageMap& map, const std::string& path) {
  const std::vector<Polyline> phreatic = phreatic_lines(map);
  const auto& shown = map.saturation.empty() ? map.head : map.saturation;
  auto [low, high] = std::ranges::minmax(shown);
  if (map.covered_heads) {
    low = std::min(low, (*map.covered_heads)[0]);
    high = std::max(high, (*map.covered_heads)[1]);
  }
  const bool of_heads = map.saturation.empty();
  const std::vector<double> levels =
      of_heads ? band_levels(low, high) : band_levels(std::min(low, 0.9), 1.0);
  const std::vector<Curve> rows =
      legend_rows(map, of_heads && levels.size() > 2, !phreatic.empty());
  // Maps that belong together have room for the same rows.
  const std::size_t most_rows = map.pressure.empty() ? 1 : 3;
  const float legend_height =
      legend_row * static_cast<float>(map.covered_heads ? most_rows : rows.size());
  const Sheet sheet{map, view_of(map, axes_bottom + legend_height), levels};
  const ModelView& view = sheet.view;
  const float right = view.left() + view.width() + Layout::gap;
  const float bar_height = std::max(view.height(), Layout::min_bar_height);
  const float title = Layout::title_width(map.title);
  const float legend = view.left() + ChartLegend::width(rows) + Layout::gap;
  const auto width = static_cast<int>(std::max({right + bar_room, title, legend}));
  const auto height = static_cast<int>(view.bottom() + bar_height + top_room);
  draw_picture(width, height, map.title, path, [&](vtkContextScene& scene) {
    add_painted(scene, [&](vtkContext2D& painter) {
      paint_outside_water(painter, sheet);
      paint_bands(painter, sheet);
      paint_edges(painter, view, map.mesh, region_edges(map.mesh), {0.25, 0.25, 0.25}, 1.0F);
      paint_equipotentials(painter, sheet, phreatic);
      paint_edges(painter, view, map.mesh, outer_edges(map.mesh), black, 1.5F);
      for (const Polyline& line : phreatic) {
        paint_polyline(painter, view, line, white, phreatic_width + 3.0F);
      }
      for (const Polyline& line : phreatic) {
        paint_polyline(painter, view, line, water_blue, phreatic_width);
      }
      view.paint_axes(painter);
      paint_bar(painter, sheet, right, view.bottom(), bar_height);
      paint_title(painter, map.title, width, height);
    });
    vtkNew<ChartLegend> lines;
    lines->place(view.left(), legend_height + 6.0F, legend_height, rows);
    if (!rows.empty()) scene.AddItem(lines);
  });
}

}  // namespace suffuse

#include "figures/seepage_map.hpp"

#include <vtkBrush.h>
#include <vtkNew.h>
#include <vtkPen.h>

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"
#include "drawing/chart_legend.hpp"
#include "drawing/color_bar.hpp"
#include "drawing/color_map.hpp"
#include "drawing/colored_triangles.hpp"
#include "drawing/contours.hpp"
#include "drawing/line_labels.hpp"
#include "drawing/model_view.hpp"
#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"
#include "drawing/type_size.hpp"
#include "figures/map_water.hpp"
#include "physics/head.hpp"
#include "values/air.hpp"
#include "values/fields.hpp"
#include "values/refusal.hpp"
#include "values/snapshot_choice.hpp"

namespace suffuse {
namespace {

using Layout = PictureLayout;
constexpr float room_above_map = 100.0F;
constexpr float line_width = 1.2F;

/// The map, its place on the picture and the levels of its colours.
struct MapSheet {
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

void paint_bands(vtkContext2D& painter, const MapSheet& sheet) {
  ColoredTriangles triangles;
  const Mesh<2>& mesh = sheet.map.mesh;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!sheet.map.air.empty() && sheet.map.air[e]) continue;
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
      triangles.add_polygon(part, sheet.band_color(band));
    }
  }
  triangles.paint(painter);
}

/// `hidden`: lines drawn over the equipotentials; labels leave them free.
void paint_equipotentials(vtkContext2D& painter, const MapSheet& sheet,
                          const std::vector<Polyline>& hidden) {
  if (!sheet.map.saturation.empty()) return;
  const std::vector<double> inner(sheet.levels.begin() + 1, sheet.levels.end() - 1);
  LineLabels labels(sheet.view);
  labels.avoid(hidden);
  const Mesh<2> mesh = drawn_mesh(sheet.map);
  paint_contours(painter, sheet.view, {mesh, sheet.map.head, inner}, {black, line_width}, labels);
}

ColorBar bar_of(const SeepageMap& map, const MapSheet& sheet) {
  ColorBar bar{{}, true, {}, map.label};
  const std::size_t bands = sheet.levels.size() - 1;
  for (std::size_t band = 0; band < bands; ++band) bar.bands.push_back(sheet.band_color(band));
  for (std::size_t k = 0; k <= bands; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(bands);
    bar.marks.push_back({share, tick_text(sheet.levels[k])});
  }
  return bar;
}

/// The common part of a head map and a saturation map.
SeepageMap map_of(const ResultsReader& run, std::size_t index, const std::optional<double>& time,
                  const std::string& what) {
  const Scene& scene = run.scene().scene;
  SeepageMap map;
  map.title = snapshot_title(run, index, time, what);
  map.mesh = run.mesh();
  map.pressure = run.field(index, "node", "pressure").values;
  const double weight = unit_weight(scene.liquid.density, scene.gravity);
  for (int i = 0; i < map.mesh.node_count(); ++i) {
    map.head.push_back(map.pressure[i] / weight + height(map.mesh.nodes[i], scene.gravity));
  }
  map.water = water_outside(run, index, map.mesh);
  map.structures = structures(map.mesh, scene);
  if (!has_gravity(scene.gravity)) map.pressure.clear();
  return map;
}

}  // namespace

Mesh<2> drawn_mesh(const SeepageMap& map) {
  return without(map.mesh, map.air);
}

std::array<double, 2> head_range(const SeepageMap& map) {
  std::array<double, 2> range{HUGE_VAL, -HUGE_VAL};
  for (const auto& corners : drawn_mesh(map).elements) {
    for (const int node : corners) {
      range = {std::min(range[0], map.head[node]), std::max(range[1], map.head[node])};
    }
  }
  return range;
}

SeepageMap head_map(const ResultsReader& run, const std::optional<double>& time,
                    const std::string& command) {
  const std::size_t index = chosen_snapshot(run, time, command);
  SeepageMap map = map_of(run, index, time, "Head");
  map.label = "head h (m)";
  map.air = elements_of_air(run, index, map.mesh);
  return map;
}

SeepageMap saturation_map(const ResultsReader& run, const std::optional<double>& time) {
  const std::size_t index = chosen_snapshot(run, time, "suffuse-post figure saturation");
  const auto names = run.field_names(index, "cell");
  if (std::ranges::find(names, "saturation") == names.end()) {
    throw InputError(InputProblem{
        "suffuse-post figure saturation", "RESULTS",
        run.folder() + ", in which every soil is saturated",
        missing_key("soil.NAME.retention", "retention = { model = \"gardner\", alpha = 2.0 }")});
  }
  SeepageMap map = map_of(run, index, time, "Saturation");
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
  // Bands without values are removed at both ends.
  const double slack = 1e-9 * (high - low);
  while (levels.size() > 2 && levels[1] <= low + slack) levels.erase(levels.begin());
  while (levels.size() > 2 && levels[levels.size() - 2] >= high - slack) levels.pop_back();
  return levels;
}

void align_maps(std::vector<SeepageMap>& maps) {
  std::array<double, 2> heads{HUGE_VAL, -HUGE_VAL};
  std::vector<OutsideWater> room;
  for (const SeepageMap& map : maps) {
    const auto [low, high] = head_range(map);
    heads = {std::min(heads[0], low), std::max(heads[1], high)};
    room.insert(room.end(), map.water.begin(), map.water.end());
  }
  for (SeepageMap& map : maps) {
    map.covered_heads = heads;
    map.room = room;
  }
}

void draw_seepage_map(const SeepageMap& map, const std::string& path) {
  const bool of_heads = map.saturation.empty();
  const std::vector<Polyline> phreatic = phreatic_lines(drawn_mesh(map), map.pressure);
  std::array<double, 2> range = head_range(map);
  if (!of_heads) range = {std::ranges::min(map.saturation), std::ranges::max(map.saturation)};
  auto [low, high] = range;
  if (map.covered_heads) {
    low = std::min(low, (*map.covered_heads)[0]);
    high = std::max(high, (*map.covered_heads)[1]);
  }
  const std::vector<double> levels =
      of_heads ? band_levels(low, high) : band_levels(std::min(low, 0.9), 1.0);
  std::vector<Curve> rows;
  if (of_heads && levels.size() > 2) {
    rows.push_back(legend_line("equipotential, head in m", black, line_width));
  }
  add_structure_legend(rows, map.structures);
  // Maps that are aligned have the same rows.
  const std::vector<OutsideWater>& room = map.covered_heads ? map.room : map.water;
  add_water_legend(rows, map.covered_heads ? !map.pressure.empty() : !phreatic.empty(),
                   !room.empty());
  const float legend_height = legend_row * static_cast<float>(rows.size());
  const auto view_above = [&](float bottom) { return view_with_water(map.mesh, room, bottom); };
  const float below = legend_height + room_below(view_above(0.0F));
  const MapSheet sheet{map, view_above(axes_bottom + below), levels};
  const ModelView& view = sheet.view;
  const ColorBar bar = bar_of(map, sheet);
  const float right = view.left() + view.width() + Layout::gap + room_at_right(view, bar);
  const float title = Layout::title_width(map.title);
  const float legend = view.left() + ChartLegend::width(rows) + Layout::gap;
  const auto width = static_cast<int>(std::max({right, title, legend}));
  const auto height = static_cast<int>(view.bottom() + view.height() + room_above_map);
  draw_picture(width, height, map.title, path, [&](vtkContextScene& scene) {
    add_painted(scene, [&](vtkContext2D& painter) {
      paint_outside_water(painter, view, map.water);
      paint_bands(painter, sheet);
      paint_edges(painter, view, map.mesh, region_edges(map.mesh), {0.25, 0.25, 0.25}, 1.0F);
      paint_equipotentials(painter, sheet, phreatic);
      paint_edges(painter, view, map.mesh, outer_edges(map.mesh), black, 1.5F);
      paint_structures(painter, view, map.mesh, map.structures);
      paint_phreatic_lines(painter, view, phreatic);
      view.paint_axes(painter);
      paint_color_bar(painter, bar, view, Layout::gap);
      paint_title(painter, map.title, width, height);
    });
    vtkNew<ChartLegend> lines;
    lines->place(view.left(), legend_height + 6.0F, legend_height, rows);
    if (!rows.empty()) scene.AddItem(lines);
  });
}

}  // namespace suffuse

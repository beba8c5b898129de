#include "figures/render.hpp"

#include <vtkBrush.h>
#include <vtkPen.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "case/errors.hpp"
#include "drawing/color_map.hpp"
#include "drawing/colored_triangles.hpp"
#include "drawing/model_view.hpp"
#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"
#include "figures/categories.hpp"
#include "results/number_text.hpp"
#include "values/fields.hpp"

namespace suffuse {
namespace {

using Layout = PictureLayout;
const std::string command = "suffuse-post render";
constexpr Color no_value{0.75, 0.75, 0.75};
constexpr Color mesh_color{0.55, 0.55, 0.55};
constexpr float top_room = 70.0F;
constexpr float bar_room = 215.0F;
constexpr int bar_bands = 256;
constexpr int max_triangles = 400'000;
constexpr int max_division = 16;

/// The colours of values: one per kind, or the colour map over a range.
struct Scale {
  std::array<double, 2> range{0.0, 1.0};
  bool exceeds_low = false;   ///< some values are below the range, which the user gave
  bool exceeds_high = false;  ///< above it
  std::vector<Category> kinds;

  [[nodiscard]] Color color(double value) const {
    for (const auto& kind : kinds) {
      if (std::abs(value - kind.value) < 0.5) return kind.color;
    }
    if (!kinds.empty() || !std::isfinite(value)) return no_value;
    return viridis((value - range[0]) / (range[1] - range[0]));
  }
};

/// The content of one picture.
struct Frame {
  std::string title;
  std::string label;
  std::string where;
  std::vector<double> values;
  std::vector<Vector<2>> positions;  ///< of points; empty for fields of elements and nodes
  Scale scale;
  bool with_elements = true;
};

std::vector<std::size_t> wanted_snapshots(const ResultsReader& results,
                                          const RenderRequest& request) {
  const auto& times = results.times();
  if (!request.snapshots.empty()) return request.snapshots;
  if (!request.all) return {snapshot_at(results, request.time)};
  if (times.empty()) throw FileError(results.folder() + ": has no snapshot yet");
  std::vector<std::size_t> every;
  for (std::size_t i = 0; i < times.size(); ++i) every.push_back(i);
  return every;
}

/// The scale that covers the values of all snapshots. The range is widened where all values agree
/// up to rounding.
Scale make_scale(const ResultsReader& results, const std::vector<std::size_t>& snapshots,
                 const FieldPlace& place, const RenderRequest& request) {
  Scale scale;
  scale.kinds = categories(results, place);
  if (!scale.kinds.empty()) return scale;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const std::size_t index : snapshots) {
    for (const double value : read_scalar(results, index, place).values) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (request.range) {
    scale.range = *request.range;
    scale.exceeds_low = low < scale.range[0];
    scale.exceeds_high = high > scale.range[1];
    return scale;
  }
  if (!(low <= high)) return scale;
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low <= 1e-9 * size || size == 0.0) {
    const double middle = 0.5 * (low + high);
    const double room = size > 0.0 ? 0.05 * size : 1.0;
    low = middle - room;
    high = middle + room;
  }
  scale.range = {low, high};
  return scale;
}

/// Values of a frame at the corners of an element.
std::array<double, 3> corner_values(const Frame& frame, const Mesh<2>& mesh, int element) {
  std::array<double, 3> values{};
  for (int a = 0; a < 3; ++a) {
    auto at = static_cast<std::size_t>(element);
    if (frame.where == "element_vertex") at = 3 * at + static_cast<std::size_t>(a);
    if (frame.where == "node") at = static_cast<std::size_t>(mesh.elements[element][a]);
    values.at(a) = frame.values[at];
  }
  return values;
}

/// Adds an element as n^2 triangles. VTK interpolates colours, not values, between the corners of a
/// triangle; only in small triangles is the difference too small to see.
void add_divided(ColoredTriangles& triangles, const std::array<Vector<2>, 3>& corners,
                 const std::array<double, 3>& values, const Scale& scale, int n) {
  const auto at = [&](int i, int j) {
    const double b = static_cast<double>(i) / n;
    const double c = static_cast<double>(j) / n;
    const Vector<2> x = (1.0 - b - c) * corners[0] + b * corners[1] + c * corners[2];
    return std::pair{x, scale.color((1.0 - b - c) * values[0] + b * values[1] + c * values[2])};
  };
  const auto add = [&](const auto& p, const auto& q, const auto& r) {
    triangles.add({p.first, q.first, r.first}, {p.second, q.second, r.second});
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      add(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + j + 1 < n) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

void paint_elements(vtkContext2D& painter, const ModelView& view, const Mesh<2>& mesh,
                    const Frame& frame) {
  const bool smooth = frame.where != "cell";
  int division = 1;
  while (smooth && division < max_division &&
         4 * division * division * mesh.element_count() <= max_triangles) {
    division *= 2;
  }
  ColoredTriangles triangles;
  for (int e = 0; e < mesh.element_count(); ++e) {
    std::array<Vector<2>, 3> corners;
    for (int a = 0; a < 3; ++a) corners.at(a) = view.pixel(mesh.nodes[mesh.elements[e][a]]);
    add_divided(triangles, corners, corner_values(frame, mesh, e), frame.scale, division);
  }
  triangles.paint(painter);
}

/// Paints the edges of elements where these are large enough not to hide the colours, the edges of
/// regions and those of the model.
void paint_mesh(vtkContext2D& painter, const ModelView& view, const Mesh<2>& mesh,
                bool with_elements) {
  const double pixels = double{view.width()} * view.height() / mesh.element_count();
  if (with_elements && pixels > 100.0)
    paint_edges(painter, view, mesh, all_edges(mesh), mesh_color, 0.7F);
  paint_edges(painter, view, mesh, region_edges(mesh), {0.25, 0.25, 0.25}, 1.0F);
  paint_edges(painter, view, mesh, outer_edges(mesh), {0.0, 0.0, 0.0}, 1.5F);
}

void paint_points(vtkContext2D& painter, const ModelView& view, const Mesh<2>& mesh,
                  const Frame& frame) {
  std::vector<Color> colors;
  for (const double value : frame.values) colors.push_back(frame.scale.color(value));
  paint_discs(painter, view, frame.positions, colors,
              disc_diameter(view, mesh, frame.positions.size()));
}

/// The label of an end of the range: four digits; zero where the value is rounding.
std::string end_text(double value, double range) {
  if (std::abs(value) < 1e-9 * range) value = 0.0;
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

void paint_bar(vtkContext2D& painter, const Frame& frame, float left, float bottom, float height) {
  painter.GetPen()->SetLineType(vtkPen::NO_PEN);
  for (int band = 0; band < bar_bands; ++band) {
    const Color color = viridis((band + 0.5) / bar_bands);
    painter.GetBrush()->SetColorF(color[0], color[1], color[2]);
    const float step = height / static_cast<float>(bar_bands);
    painter.DrawRect(left, bottom + static_cast<float>(band) * step, Layout::bar_width, step);
  }
  painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
  painter.GetPen()->SetColorF(0.0, 0.0, 0.0);
  painter.GetPen()->SetWidth(1.5F);
  const double low = frame.scale.range[0];
  const double high = frame.scale.range[1];
  const auto mark = [&](double value, const std::string& text) {
    const float y = bottom + height * static_cast<float>((value - low) / (high - low));
    painter.DrawLine(left + Layout::bar_width, y, left + Layout::bar_width + 8.0F, y);
    paint_text(painter, text, 18, left + Layout::bar_width + 14.0F, y, Anchor::left);
  };
  mark(low, (frame.scale.exceeds_low ? "<= " : "") + end_text(low, high - low));
  mark(high, (frame.scale.exceeds_high ? ">= " : "") + end_text(high, high - low));
  for (const double tick : round_ticks(low, high)) {
    const double room = 24.0 / height * (high - low);
    if (tick > low + room && tick < high - room) {
      mark(tick, tick_text(tick));
    }
  }
  paint_text(painter, frame.label, 20, left + Layout::bar_width + 150.0F, bottom + height / 2.0F,
             Anchor::center, 90.0);
}

/// Width of the legend of kinds, pixels.
float kinds_width(const Frame& frame) {
  std::size_t letters = frame.label.size();
  for (const auto& kind : frame.scale.kinds) letters = std::max(letters, kind.name.size());
  return 60.0F + 11.0F * static_cast<float>(letters);
}

void paint_kinds(vtkContext2D& painter, const Frame& frame, float left, float top) {
  paint_text(painter, frame.label, 20, left, top - 12.0F, Anchor::left);
  float y = top - 48.0F;
  for (const auto& kind : frame.scale.kinds) {
    painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
    painter.GetPen()->SetColorF(0.0, 0.0, 0.0);
    painter.GetPen()->SetWidth(1.0F);
    painter.GetBrush()->SetColorF(kind.color[0], kind.color[1], kind.color[2]);
    painter.DrawRect(left, y - 11.0F, 30.0F, 22.0F);
    paint_text(painter, kind.name, 18, left + 42.0F, y, Anchor::left);
    y -= 34.0F;
  }
}

void draw_frame(const Mesh<2>& mesh, const Frame& frame, const std::string& path) {
  const ModelView view(mesh, axes_left, axes_bottom, Layout::max_width, Layout::max_height);
  const float right = view.left() + view.width() + Layout::gap;
  const bool by_kind = !frame.scale.kinds.empty();
  const float side = by_kind ? kinds_width(frame) : bar_room;
  // Wide enough for a long title over a narrow model.
  const float title = Layout::title_width(frame.title);
  const auto width = static_cast<int>(std::max(right + side, title));
  const auto height =
      static_cast<int>(view.bottom() + std::max(view.height(), Layout::min_bar_height) + top_room);
  draw_picture(width, height, frame.title, path, [&](vtkContextScene& scene) {
    add_painted(scene, [&](vtkContext2D& painter) {
      const bool points =
          !frame.positions.empty() || frame.where == "solid" || frame.where == "liquid";
      if (!points) paint_elements(painter, view, mesh, frame);
      paint_mesh(painter, view, mesh, frame.with_elements);
      if (points) paint_points(painter, view, mesh, frame);
      view.paint_axes(painter);
      paint_title(painter, frame.title, width, height);
      if (by_kind) {
        paint_kinds(painter, frame, right, view.bottom() + view.height());
      } else {
        paint_bar(painter, frame, right, view.bottom(),
                  std::max(view.height(), Layout::min_bar_height));
      }
    });
  });
}

/// `FILE_0007.png` for `FILE.png` and 7.
std::string numbered(const std::string& path, std::size_t number) {
  char digits[24];
  std::snprintf(digits, sizeof digits, "_%04zu", number);
  const std::filesystem::path file(path);
  return (file.parent_path() / (file.stem().string() + digits + file.extension().string()))
      .string();
}

}  // namespace

std::array<double, 2> parse_range(const std::string& text) {
  const auto comma = text.find(',');
  if (comma != std::string::npos) {
    const auto low = parse_number(text.substr(0, comma));
    const auto high = parse_number(text.substr(comma + 1));
    if (low && high && std::isfinite(*low) && std::isfinite(*high) && *low < *high) {
      return {*low, *high};
    }
  }
  throw InputError(std::vector{
      InputProblem{command, "--range", '"' + text + '"', "LO,HI with LO below HI", ""}});
}

std::vector<std::string> render(const ResultsReader& results, const RenderRequest& request) {
  require_png(request.output, command);
  if (request.time && !std::isfinite(*request.time)) {
    throw InputError(std::vector{
        InputProblem{command, "--time", number_text(*request.time), "a time in seconds", ""}});
  }
  const auto snapshots = wanted_snapshots(results, request);
  FieldPlace place = find_field(results, snapshots.front(), request.field, request.on, command);
  place.change = request.change;
  const Mesh<2> mesh = results.mesh();
  Frame frame;
  frame.where = place.where;
  frame.with_elements = request.mesh;
  frame.scale = make_scale(results, snapshots, place, request);
  const bool several = request.all || !request.snapshots.empty();
  std::vector<std::string> written;
  for (const std::size_t index : snapshots) {
    const ScalarField field = read_scalar(results, index, place);
    frame.values = field.values;
    frame.label = field_label(place, field);
    frame.title = snapshot_title(results, index, request.time);
    if (place.where == "solid" || place.where == "liquid") {
      frame.positions = results.point_positions(index, place.where);
    }
    written.push_back(several ? numbered(request.output, index) : request.output);
    draw_frame(mesh, frame, written.back());
  }
  return written;
}

}  // namespace suffuse

#include "figures/field_picture.hpp"

#include <vtkBrush.h>
#include <vtkPen.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "drawing/chart_legend.hpp"
#include "drawing/colored_triangles.hpp"
#include "drawing/line_labels.hpp"
#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"
#include "drawing/type_size.hpp"
#include "figures/arrows.hpp"
#include "figures/map_water.hpp"
#include "values/air.hpp"
#include "values/point_cells.hpp"

namespace suffuse {
namespace {

using Layout = PictureLayout;
constexpr Color mesh_color{0.55, 0.55, 0.55};
constexpr Color stream_color{0.75, 0.0, 0.1};
constexpr Color region_edge_color{0.25, 0.25, 0.25};
constexpr float room_above_picture = 70.0F;
/// Room for the text of a head next to a water level at the top of the view, pixels.
constexpr int level_room = 30;
constexpr float contour_width = 1.2F;
constexpr float stream_width = 1.8F;
constexpr float path_width = 2.5F;
constexpr double noticed_misfit = 0.01;
/// Largest number of small triangles of a PNG, and of an SVG or PDF, which stores each of them.
constexpr int max_triangles = 400'000;
constexpr int max_drawn_triangles = 10'000;
constexpr int max_division = 16;

/// Adds an element as n^2 triangles. VTK interpolates colours, not values, between the corners of a
/// triangle; the error is invisible only if triangles are small. `flat`: one colour each.
template <int Dim, class Add>
void add_divided(const Add& add_triangle, const std::array<Vector<Dim>, 3>& corners,
                 const std::array<double, 3>& values, const FieldScale& scale, int n, bool flat) {
  struct Corner {
    Vector<Dim> at;
    double value;
  };
  const auto at = [&](int i, int j) {
    const double b = static_cast<double>(i) / n;
    const double c = static_cast<double>(j) / n;
    const double value = (1.0 - b - c) * values[0] + b * values[1] + c * values[2];
    // Interpolation between equal infinite values would give NaN.
    const bool is_one = values[0] == values[1] && values[1] == values[2];
    return Corner{(1.0 - b - c) * corners[0] + b * corners[1] + c * corners[2],
                  is_one ? values[0] : value};
  };
  const auto add = [&](const Corner& p, const Corner& q, const Corner& r) {
    const double mean = (p.value + q.value + r.value) / 3.0;
    const auto color = [&](const Corner& corner) {
      return scale.color(flat ? mean : corner.value);
    };
    add_triangle(std::array<Vector<Dim>, 3>{p.at, q.at, r.at},
                 std::array<Color, 3>{color(p), color(q), color(r)});
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      add(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + j + 1 < n) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

/// Into how many parts the sides of an element are divided.
int division_of(const PictureModel& model, const FieldPicture& picture, bool flat) {
  const bool smooth = picture.where != "cell";
  const std::ptrdiff_t most = flat ? max_drawn_triangles : max_triangles;
  int division = 1;
  while (smooth && division < max_division &&
         4L * division * division * model.visible_count <= most) {
    division *= 2;
  }
  return division;
}

void paint_elements(vtkContext2D& painter, const ModelView& view, const PictureModel& model,
                    const FieldPicture& picture, bool flat) {
  const Mesh<2>& mesh = model.mesh;
  const int division = division_of(model, picture, flat);
  ColoredTriangles triangles;
  const auto add = [&](const auto& corners, const auto& colors) { triangles.add(corners, colors); };
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (model.visible[e] == 0 || (!picture.air.empty() && picture.air[e])) continue;
    std::array<Vector<2>, 3> corners;
    for (int a = 0; a < 3; ++a) corners.at(a) = view.pixel(mesh.nodes[mesh.elements[e][a]]);
    add_divided(add, corners, corner_values(picture, mesh, e), picture.scale, division, flat);
  }
  triangles.paint(painter);
}

/// Edges of elements are drawn if elements are large enough for the colours to be seen, if no lines
/// of the field are drawn, and not over points, which are no elements.
bool shows_element_edges(const ModelView& view, const PictureModel& model,
                         const FieldPicture& picture) {
  const double pixels = double{view.width()} * view.height() /
                        static_cast<double>(std::max<std::ptrdiff_t>(1, model.visible_count));
  const bool lines = picture.contours || !picture.arrows.empty() || !picture.streamfunction.empty();
  return picture.mesh_edges && pixels > 100.0 && !lines && !picture.of_points();
}

void paint_points(vtkContext2D& painter, const ModelView& view, const PictureModel& model,
                  const FieldPicture& picture) {
  ColoredTriangles cells;
  for (const PointCell& cell : point_cells(model.mesh, picture.positions, picture.volumes)) {
    std::vector<Vector<2>> corners;
    corners.reserve(cell.corners.size());
    for (const Vector<2>& x : cell.corners) corners.push_back(view.pixel(x));
    cells.add_polygon(corners, picture.scale.color(picture.values[cell.point]));
  }
  cells.paint(painter);
}

/// Streamlines at whole multiples of the discharge of a tube, beginning with one half.
std::vector<Polyline> streamlines_of(const PictureModel& model, const FieldPicture& picture) {
  std::vector<Polyline> lines;
  if (picture.streamfunction.empty()) return lines;
  const double most = std::ranges::max(picture.streamfunction);
  for (double psi = 0.5 * picture.tube; psi < most; psi += picture.tube) {
    for (auto& line : contour_lines(model.mesh, picture.streamfunction, psi)) {
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

/// Paints white over what extends beyond the view of a part of the model.
void paint_margins(vtkContext2D& painter, const ModelView& view, int width, int height) {
  painter.GetPen()->SetLineType(vtkPen::NO_PEN);
  painter.GetBrush()->SetColorF(1.0, 1.0, 1.0);
  const float right = view.left() + view.width();
  const float top = view.bottom() + view.height();
  const auto w = static_cast<float>(width);
  const auto h = static_cast<float>(height);
  painter.DrawRect(0.0F, 0.0F, view.left(), h);
  painter.DrawRect(right, 0.0F, std::max(1.0F, w - right), h);
  painter.DrawRect(0.0F, 0.0F, w, view.bottom());
  painter.DrawRect(0.0F, top, w, std::max(1.0F, h - top));
  painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
  painter.GetPen()->SetColorF(mesh_color[0], mesh_color[1], mesh_color[2]);
  painter.GetPen()->SetWidth(1.0F);
  const std::array<std::array<float, 4>, 4> sides{
      {{view.left(), view.bottom(), right, view.bottom()},
       {right, view.bottom(), right, top},
       {right, top, view.left(), top},
       {view.left(), top, view.left(), view.bottom()}}};
  for (const auto& s : sides) painter.DrawLine(s[0], s[1], s[2], s[3]);
}

std::vector<Curve> picture_legend_rows(const FieldPicture& picture, const Structures& structures,
                                       bool has_water) {
  std::vector<Curve> rows;
  if (picture.contours) {
    rows.push_back(legend_line("line of equal " + picture.label, black, contour_width));
  }
  if (!picture.streamfunction.empty()) {
    std::string text = "streamline; " + digits_text(picture.tube, 4) + " m3/s per m between two";
    if (picture.misfit > noticed_misfit) {
      text +=
          "; unsteady flow: " + digits_text(100.0 * picture.misfit, 4) + " % of the flux missed";
    }
    rows.push_back(legend_line(text, stream_color, stream_width));
  }
  if (!picture.paths.empty()) {
    rows.push_back(legend_line("streamlines, " + digits_text(picture.tube, 4) + " m3/s each", black,
                               path_width));
  }
  add_structure_legend(rows, structures);
  add_water_legend(rows, false, has_water);
  return rows;
}

/// Layout of one picture.
struct Paper {
  const PictureModel& model;
  const FieldPicture& picture;
  ModelView view;
  int width = 0;
  int height = 0;
  bool flat = false;
  float gap = 0.0F;  ///< between the model and what is at its right
};

void paint_map(vtkContext2D& painter, const Paper& sheet, const Arrows& arrows) {
  const auto& [model, picture, view, width, height, flat, gap] = sheet;
  if (!model.box) paint_outside_water(painter, view, picture.water);
  if (!picture.of_points()) paint_elements(painter, view, model, picture, flat);
  if (shows_element_edges(view, model, picture)) {
    paint_edges(painter, view, model.mesh, model.all_edges, mesh_color, 0.7F);
  }
  if (picture.of_points()) paint_points(painter, view, model, picture);
  paint_edges(painter, view, model.mesh, model.outlines.regions, region_edge_color, 1.5F);
  paint_edges(painter, view, model.mesh, model.outlines.ground, region_edge_color, 1.0F);
  paint_edges(painter, view, model.mesh, model.outlines.open, mesh_color, 1.0F);
  LineLabels labels(view);
  const auto streamlines = streamlines_of(model, picture);
  paint_edged_polylines(painter, view, streamlines, stream_color, white, stream_width);
  if (picture.contours) {
    const auto at_nodes =
        picture.line_values.empty() ? nodal_values(model.mesh, picture) : picture.line_values;
    const Mesh<2> mesh = without(model.mesh, picture.air);
    paint_contours(painter, view, {mesh, at_nodes, picture.scale.levels()}, {black, contour_width},
                   labels);
  }
  arrows.paint(painter);
  paint_structures(painter, view, model.mesh, model.structures);
  paint_edges(painter, view, model.mesh, model.outlines.outer, black, 1.5F);
  if (model.box) paint_margins(painter, view, width, height);
  view.paint_axes(painter, model.axes);
}

/// What a picture of a model in space shows.
SpaceDrawing space_drawing(const Paper& sheet) {
  const PictureModel& model = sheet.model;
  const FieldPicture& picture = sheet.picture;
  const ModelView& view = sheet.view;
  SpaceDrawing drawing;
  const auto pixel = [&](const Vector<3>& x) { return space_pixel(view, x); };
  const auto at_node = [&](int node) { return pixel(model.projected(node)); };
  const auto add_edges = [&](const Edges& edges, const Color& color, float line_width) {
    for (const auto& [i, j] : edges) drawing.add_line({at_node(i), at_node(j)}, color, line_width);
  };
  const auto add = [&](const auto& corners, const auto& colors) {
    drawing.add_triangle(corners, colors);
  };
  const int division = division_of(model, picture, sheet.flat);
  for (int e = 0; e < model.mesh.element_count() && !picture.hollow; ++e) {
    if (model.visible[e] == 0) continue;
    const auto& [a, b, c] = model.mesh.elements[e];
    add_divided(add, std::array<Vector<3>, 3>{at_node(a), at_node(b), at_node(c)},
                corner_values(picture, model.mesh, e), picture.scale, division, sheet.flat);
  }
  for (const auto& [corners, color] : picture.inside) {
    drawing.add_triangle({pixel(corners[0]), pixel(corners[1]), pixel(corners[2])},
                         {color, color, color});
  }
  for (const auto& [ends, color] : picture.paths) {
    drawing.add_line({pixel(ends[0]), pixel(ends[1])}, color, path_width);
  }
  if (!picture.hollow && shows_element_edges(view, model, picture)) {
    add_edges(model.all_edges, mesh_color, 0.7F);
  }
  if (!picture.hollow) add_edges(model.outlines.regions, region_edge_color, 1.5F);
  add_edges(model.outlines.outer, picture.hollow ? mesh_color : black, 1.5F);
  return drawing;
}

/// Edges where two triangles of a projected surface meet at an angle, and edges of one triangle.
Edges bent_edges(const Mesh<2>& mesh, const std::vector<double>& depth) {
  constexpr double cosine = 0.94;  // cosine of 20 degrees
  const auto normal = [&](int triangle) {
    std::array<Vector<3>, 3> x;
    for (int a = 0; a < 3; ++a) {
      const int node = mesh.elements[triangle][a];
      x.at(a) << mesh.nodes[node], depth[node];
    }
    return (x[1] - x[0]).cross(x[2] - x[0]).normalized().eval();
  };
  Edges edges;
  for (const auto& [edge, triangles] : elements_of_edges(mesh)) {
    const bool bends =
        triangles.size() != 2 || normal(triangles[0]).dot(normal(triangles[1])) < cosine;
    if (bends) edges.push_back(edge);
  }
  return edges;
}

ModelView view_of(const PictureModel& model, const FieldPicture& picture, float bottom) {
  if (!model.box) return view_with_water(model.mesh, picture.room, bottom);
  return {(*model.box)[0], (*model.box)[1],   axes_left,
          bottom,          Layout::max_width, Layout::max_height};
}

/// The layout of a picture with `legend` pixels of rows below the model, wide enough for its title.
Paper paper_for(const PictureModel& model, const FieldPicture& picture, float legend,
                const ColorBar& bar) {
  const FieldScale& scale = picture.scale;
  const bool by_kind = !scale.kinds.empty();
  float bottom = axes_bottom + legend;
  if (!by_kind) bottom += room_below(view_of(model, picture, 0.0F));
  Paper paper{model, picture, view_of(model, picture, bottom)};
  paper.gap = (model.space ? 3.0F : 1.0F) * Layout::gap;  // in space with room for an axis
  const ModelView& view = paper.view;
  const float side = by_kind ? kinds_width(scale, picture.label) : room_at_right(view, bar);
  paper.width = static_cast<int>(
      std::max(view.left() + view.width() + paper.gap + side, Layout::title_width(picture.title)));
  const float kinds = by_kind ? kinds_height(scale) : 0.0F;
  paper.height =
      static_cast<int>(view.bottom() + std::max(view.height(), kinds) + room_above_picture);
  return paper;
}

}  // namespace

PictureModel picture_model(const Mesh<2>& mesh, const std::optional<ViewBox>& box,
                           std::vector<bool> is_open) {
  PictureModel model;
  model.mesh = mesh;
  model.all_edges = all_edges(mesh);
  is_open.resize(mesh.region_names.size(), false);
  model.outlines = outlines(mesh, is_open);
  model.box = box;
  for (const auto& nodes : mesh.elements) {
    bool is_visible = true;
    if (box) {
      const auto& [a, b, c] = nodes;
      const Vector<2> low = mesh.nodes[a].cwiseMin(mesh.nodes[b]).cwiseMin(mesh.nodes[c]);
      const Vector<2> high = mesh.nodes[a].cwiseMax(mesh.nodes[b]).cwiseMax(mesh.nodes[c]);
      is_visible =
          (low.array() < (*box)[1].array()).all() && (high.array() > (*box)[0].array()).all();
    }
    model.visible.push_back(is_visible ? 1 : 0);
    model.visible_count += is_visible ? 1 : 0;
  }
  return model;
}

PictureModel space_model(const Mesh<3>& mesh, const Sheet& surface, const Vector<3>& upward,
                         const Camera& camera) {
  PictureModel model;
  SpaceBox box{space_view(upward, camera), mesh.nodes.front(), mesh.nodes.front()};
  for (const Vector<3>& x : mesh.nodes) {
    box.low = box.low.cwiseMin(x);
    box.high = box.high.cwiseMax(x);
  }
  for (const EdgePlace& place : surface.nodes) {
    const Vector<3> x = box.view.project(position(mesh, place));
    model.mesh.nodes.emplace_back(x[0], x[1]);
    model.depth.push_back(x[2]);
  }
  model.mesh.elements = surface.triangles;
  model.mesh.region_names = mesh.region_names;
  for (const int e : surface.element) {
    model.mesh.element_region.push_back(mesh.element_region[e]);
  }
  model.all_edges = all_edges(model.mesh);
  model.outlines.regions = region_edges(model.mesh);
  model.outlines.outer = bent_edges(model.mesh, model.depth);
  for (int t = 0; t < model.mesh.element_count(); ++t) {
    model.visible.push_back(element_volume(model.mesh, t) > 0.0 ? 1 : 0);
    model.visible_count += model.visible.back();
  }
  model.space = box;
  return model;
}

std::array<double, 3> corner_values(const FieldPicture& picture, const Mesh<2>& mesh, int element) {
  std::array<double, 3> values{};
  for (int a = 0; a < 3; ++a) {
    auto at = static_cast<std::size_t>(element);
    if (picture.where == "element_vertex") at = 3 * at + static_cast<std::size_t>(a);
    if (picture.where == "node") at = static_cast<std::size_t>(mesh.elements[element][a]);
    values.at(a) = picture.values[at];
  }
  return values;
}

std::vector<double> nodal_values(const Mesh<2>& mesh, const FieldPicture& picture) {
  if (picture.where == "node") return picture.values;
  std::vector<double> sums(mesh.nodes.size(), 0.0);
  std::vector<double> areas(mesh.nodes.size(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double area = element_volume(mesh, e);
    const auto values = corner_values(picture, mesh, e);
    for (int a = 0; a < 3; ++a) {
      sums[mesh.elements[e][a]] += area * values.at(a);
      areas[mesh.elements[e][a]] += area;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= areas[i];
  return sums;
}

void draw_field_picture(const PictureModel& model, const FieldPicture& picture,
                        const std::string& path) {
  const bool has_water = !picture.room.empty() && !model.box;
  const std::vector<Curve> rows = picture_legend_rows(picture, model.structures, has_water);
  const float legend_height = legend_row * static_cast<float>(rows.size());
  const bool has_arrows = !picture.arrows.empty();
  const FieldScale& scale = picture.scale;
  const bool by_kind = !scale.kinds.empty();
  const ColorBar bar = by_kind ? ColorBar{} : bar_of(scale, picture.label);
  Paper sheet = paper_for(model, picture, legend_height + (has_arrows ? legend_row : 0.0F), bar);
  if (has_water) sheet.height += level_room;
  sheet.width = std::max(
      sheet.width, static_cast<int>(sheet.view.left() + Layout::gap + ChartLegend::width(rows)));
  sheet.flat = std::filesystem::path(path).extension() != ".png";
  const Arrows arrows(model.mesh, picture.arrows, sheet.view);
  const ModelView& view = sheet.view;
  SpaceDrawing space;
  if (model.space) space = space_drawing(sheet);
  const auto fill = [&](vtkContextScene& scene) {
    add_painted(scene, [&](vtkContext2D& painter) {
      if (model.space) {
        paint_space_axes(painter, view, *model.space);
      } else {
        paint_map(painter, sheet, arrows);
      }
      paint_title(painter, picture.title, sheet.width, sheet.height);
      if (has_arrows) {
        const float y = legend_height + 0.5F * legend_row + 6.0F;
        arrows.paint_reference(painter, view.left(), y);
        const std::string text = picture.arrow_label + ", " + digits_text(arrows.reference(), 4) +
                                 " " + picture.arrow_unit;
        paint_text(painter, text, 18, view.left() + 76.0F, y, Anchor::left);
      }
      if (by_kind) {
        paint_kinds(painter, scale, picture.label, view.left() + view.width() + sheet.gap,
                    view.bottom() + std::max(view.height(), kinds_height(scale)));
      } else {
        paint_color_bar(painter, bar, view, sheet.gap);
      }
    });
    vtkNew<ChartLegend> lines;
    lines->place(view.left(), legend_height + 6.0F, legend_height, rows);
    if (!rows.empty()) scene.AddItem(lines);
  };
  draw_picture(sheet.width, sheet.height, picture.title, path, fill,
               model.space ? &space : nullptr);
}

}  // namespace suffuse

#include "figures/model_sketch.hpp"

#include <vtkBrush.h>
#include <vtkPen.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "case/free_space.hpp"
#include "common/errors.hpp"
#include "drawing/chart_legend.hpp"
#include "drawing/color_map.hpp"
#include "drawing/model_view.hpp"
#include "drawing/picture.hpp"
#include "drawing/type_size.hpp"
#include "figures/field_picture.hpp"
#include "figures/map_water.hpp"
#include "files/number_text.hpp"
#include "mesh/faces.hpp"
#include "values/derived_fields.hpp"
#include "values/run_names.hpp"
#include "values/scene_words.hpp"
#include "values/sheet.hpp"
#include "values/snapshot_choice.hpp"

namespace suffuse {
namespace {

constexpr Color white{1.0, 1.0, 1.0};
constexpr Color mesh_grey{0.4, 0.4, 0.4};
constexpr Color red{0.84, 0.0, 0.0};
constexpr Color blue{0.1, 0.35, 0.9};
/// Green and purple as in the paper, then others; impervious boundaries are orange.
constexpr std::array<Color, 5> boundary_colors{
    {{0.0, 0.55, 0.25}, {0.55, 0.1, 0.6}, {0.0, 0.6, 0.75}, {0.75, 0.6, 0.0}, {0.35, 0.35, 0.35}}};
constexpr Color impervious_color{0.95, 0.5, 0.1};
constexpr Color free_water_tint{0.86, 0.94, 1.0};
constexpr float boundary_width = 6.0F;
constexpr float max_width = 900.0F;
constexpr float max_height = 1100.0F;
constexpr float title_room = 80.0F;
constexpr float legend_gap = 50.0F;

/// A constant as "6000"; a value that changes in time as "0 to 6000", its smallest and largest.
std::string range_text(const TimeFunction& f) {
  const std::string smallest = number_text(f.smallest());
  return f.is_constant() ? smallest : smallest + " to " + number_text(f.largest());
}

/// The conditions on a boundary, or at a well; empty where it is impervious.
std::string condition_text(const BoundaryCondition& b) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (b.pressure) add("pressure " + range_text(*b.pressure) + " Pa");
  if (b.velocity) add("velocity " + range_text(*b.velocity) + " m/s");
  if (b.darcy_flux) add("Darcy flux " + range_text(*b.darcy_flux) + " m/s");
  if (b.head) add("head " + range_text(*b.head) + " m");
  if (b.seepage_face) add("seepage face");
  if (b.rain) add("rain " + range_text(*b.rain) + " m/s");
  if (b.rate) add("rate " + range_text(*b.rate) + " m3/s");
  const double enters =
      std::max(b.velocity.value_or(0.0).largest(), b.darcy_flux.value_or(0.0).largest());
  if (b.concentration || enters > 0.0) add("c = " + range_text(b.concentration.value_or(0.0)));
  return text;
}

std::string traction_text(const VectorFunction& traction) {
  std::string text;
  for (std::size_t d = 0; d < traction.given; ++d) {
    std::vector<std::pair<double, double>> kilopascals;
    for (const auto& [t, value] : traction.knots) kilopascals.emplace_back(t, value.at(d) / 1000.0);
    text += (d == 0 ? "traction " : ", ") + range_text(TimeFunction(kilopascals));
  }
  return text + " kPa";
}

/// What holds or loads soil that moves at a named boundary; empty if nothing does.
std::string support_text(const Scene& scene, const std::string& name) {
  const auto condition = std::ranges::find(scene.boundaries, name, &BoundaryCondition::on);
  if (condition == scene.boundaries.end() || !scene.moves()) return "";
  std::string text;
  if (condition->fix == Fixing::both) text = "held";
  if (condition->fix == Fixing::normal) text = "held along its normal";
  if (!condition->traction) return text;
  return text + (text.empty() ? "" : ", ") + traction_text(*condition->traction);
}

/// What the scene says of the water at a named boundary; empty where it is impervious.
std::string text_of(const Scene& scene, const std::string& name) {
  const auto condition = std::ranges::find(scene.boundaries, name, &BoundaryCondition::on);
  if (condition != scene.boundaries.end()) return condition_text(*condition);
  const auto wall = std::ranges::find(scene.walls, name, &Wall::on);
  if (wall == scene.walls.end()) return "";
  if (wall->conductance == 0.0) return "impervious wall";
  return "wall, conductance " + number_text(wall->conductance) + " 1/s";
}

/// Outer faces that belong to no named boundary.
template <int Dim>
std::vector<std::array<int, Dim>> unnamed_faces(const Mesh<Dim>& mesh) {
  std::vector<std::array<int, Dim>> named;
  for (const auto& boundary : mesh.boundaries) {
    for (const auto& face : boundary.faces) named.push_back(face_key<Dim>(face));
  }
  std::ranges::sort(named);
  const FaceTable<Dim> owners(mesh);
  std::vector<std::array<int, Dim>> rest;
  for (const auto& element : mesh.elements) {
    for (int corner = 0; corner <= Dim; ++corner) {
      const auto face = face_key<Dim>(face_opposite<Dim>(element, corner));
      if (owners.owners(face) == 1 && !std::ranges::binary_search(named, face)) {
        rest.push_back(face);
      }
    }
  }
  return rest;
}

/// The colour of the soil on maps of regions, light enough for the mesh and the points over it.
Color soil_tint(int region, std::size_t count) {
  constexpr double white_share = 0.55;
  Color tint = region_color(static_cast<std::size_t>(region), count);
  for (double& part : tint) part = white_share + (1.0 - white_share) * part;
  return tint;
}

struct RegionTint {
  std::string label;
  Color color{};
};

template <int Dim>
std::vector<RegionTint> region_tints(const ResultsReader& run, const Mesh<Dim>& mesh) {
  const Scene& scene = run.scene().scene;
  std::vector<RegionTint> tints;
  for (int r = 0; r < static_cast<int>(mesh.region_names.size()); ++r) {
    const std::string content = free_space_text(mesh, scene, r);
    tints.push_back({region_label(mesh, scene, r), content.empty()
                                                       ? soil_tint(r, mesh.region_names.size())
                                                   : content.starts_with("air") ? white
                                                                                : free_water_tint});
  }
  return tints;
}

void paint_tints(vtkContext2D& painter, const ModelView& view, const Mesh<2>& mesh,
                 const std::vector<RegionTint>& tints) {
  painter.GetPen()->SetLineType(vtkPen::NO_PEN);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto& color = tints[mesh.element_region[e]].color;
    painter.GetBrush()->SetColorF(color[0], color[1], color[2]);
    std::array<float, 3> x{};
    std::array<float, 3> y{};
    for (int a = 0; a < 3; ++a) {
      const Vector<2> at = view.pixel(mesh.nodes[mesh.elements[e][a]]);
      x.at(a) = static_cast<float>(at[0]);
      y.at(a) = static_cast<float>(at[1]);
    }
    painter.DrawPolygon(x.data(), y.data(), 3);
  }
  painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
}

Curve line_row(const std::string& label, const Color& color, float width) {
  Curve row;
  row.label = label;
  row.color = color;
  row.width = width;
  return row;
}

Curve marker_row(const std::string& label, const Color& color, Marker marker) {
  Curve row = line_row(label, color, 1.0F);
  row.markers = true;
  row.marker = marker;
  return row;
}

/// The row of a region; white has a frame.
Curve tint_row(const RegionTint& tint) {
  const bool is_white = tint.color == white;
  Curve row = marker_row(tint.label, is_white ? mesh_grey : tint.color, Marker::square);
  row.hollow = is_white;
  return row;
}

/// The colour of a boundary by its number.
template <int Dim>
Color boundary_color(const std::vector<SketchedBoundary<Dim>>& boundaries, std::size_t number) {
  if (boundaries[number].label.ends_with("impervious")) return impervious_color;
  return boundary_colors.at(number % boundary_colors.size());
}

std::string count_text(std::size_t count, const std::string& kind) {
  return std::to_string(count) + " " + kind + (count == 1 ? "" : "s");
}

std::string title_of(const ResultsReader& run) {
  return run.scene().scene.name +
         (is_double_point(run) ? ", double-point model" : ", single-point model");
}

void draw_space_sketch(const ResultsReader& run, const std::string& path);

}  // namespace

template <int Dim>
std::string region_label(const Mesh<Dim>& mesh, const Scene& scene, int number) {
  const std::string& region = mesh.region_names[number];
  if (const std::string content = free_space_text(mesh, scene, number); !content.empty()) {
    return region + ": " + content;
  }
  const Soil* soil = scene.find_soil(region);
  if (soil == nullptr || !soil->erosion.law->erodes()) {
    return region + ": soil, does not erode";
  }
  return region + ": soil, erodes (" + std::string(soil->erosion.law->word) + " law)";
}

std::vector<SketchedBoundary<2>> sketched_boundaries(const ResultsReader& run) {
  return sketched_boundaries(run.mesh(), run.scene().scene);
}

template <int Dim>
std::vector<SketchedBoundary<Dim>> sketched_boundaries(const Mesh<Dim>& mesh, const Scene& scene) {
  std::vector<SketchedBoundary<Dim>> found;
  // By their support; those without one are last.
  std::map<std::string, SketchedBoundary<Dim>, std::greater<>> impervious;
  const auto add_impervious = [&](const std::string& name, const std::string& support,
                                  const std::vector<std::array<int, Dim>>& faces) {
    auto& [label, all] = impervious[support];
    label += (label.empty() ? "" : ", ") + name;
    all.insert(all.end(), faces.begin(), faces.end());
  };
  for (const auto& boundary : mesh.boundaries) {
    const std::string text = text_of(scene, boundary.name);
    const std::string support = support_text(scene, boundary.name);
    if (text.empty()) {
      add_impervious(boundary.name, support, boundary.faces);
    } else {
      std::string label = boundary.name + ": " + text;
      if (!support.empty()) label.append(", ").append(support);
      found.push_back({std::move(label), boundary.faces});
    }
  }
  if (const auto rest = unnamed_faces(mesh); !rest.empty()) add_impervious("unnamed", "", rest);
  for (auto& [support, boundary] : impervious) {
    boundary.label += ": impervious" + (support.empty() ? "" : ", " + support);
    found.push_back(std::move(boundary));
  }
  return found;
}
template std::string region_label(const Mesh<2>&, const Scene&, int);
template std::string region_label(const Mesh<3>&, const Scene&, int);
template std::vector<SketchedBoundary<2>> sketched_boundaries(const Mesh<2>&, const Scene&);
template std::vector<SketchedBoundary<3>> sketched_boundaries(const Mesh<3>&, const Scene&);

namespace {

struct SketchLayout {
  float legend_left;
  float legend_top;
  int width;
  int height;
};

/// The legend is at the right of the model, or below one that is lower than the legend; then the
/// view moves up.
SketchLayout sketch_layout(const Mesh<2>& mesh, ModelView& view, const std::vector<Curve>& rows) {
  const float legend_height = legend_row * static_cast<float>(rows.size());
  const float legend_width = ChartLegend::width(rows) + legend_gap;
  const float right = view.left() + view.width() + legend_gap;
  const float top = view.bottom() + view.height();
  if (legend_height <= view.height()) {
    return {right, top, static_cast<int>(right + legend_width), static_cast<int>(top + title_room)};
  }
  view = ModelView(mesh, axes_left, axes_bottom + legend_height, max_width, max_height);
  const auto width = static_cast<int>(std::max(right, axes_left + legend_width));
  return {axes_left, legend_height + 6.0F, width,
          static_cast<int>(top + legend_height + title_room)};
}

}  // namespace

void draw_model_sketch(const ResultsReader& run, const std::string& path) {
  expect_snapshots(run);
  if (run.dimension() == 3) {
    draw_space_sketch(run, path);
    return;
  }
  const bool double_point = is_double_point(run);
  const Mesh<2> mesh = run.mesh();
  const auto solid = run.point_positions(0, "solid");
  const auto liquid = double_point ? run.point_positions(0, "liquid") : std::vector<Vector<2>>{};
  const auto boundaries = sketched_boundaries(run);
  const auto tints = region_tints(run, mesh);

  std::vector<Curve> rows;
  for (std::size_t b = 0; b < boundaries.size(); ++b) {
    rows.push_back(line_row(boundaries[b].label, boundary_color(boundaries, b), boundary_width));
  }
  ModelView view(mesh, axes_left, axes_bottom, max_width, max_height);
  const float small = disc_diameter(view, mesh, std::max(liquid.size(), solid.size()));
  const bool shows_points = small > smallest_disc;
  rows.push_back(
      marker_row(count_text(solid.size(), double_point ? "solid point" : "material point") +
                     (shows_points ? "" : ", too dense to draw"),
                 red, Marker::circle));
  if (double_point) {
    rows.push_back(marker_row(count_text(liquid.size(), "liquid point"), blue, Marker::circle));
  }
  rows.push_back(line_row(count_text(mesh.elements.size(), "element"), black, 1.0F));
  for (const auto& tint : tints) rows.push_back(tint_row(tint));
  const SketchLayout layout = sketch_layout(mesh, view, rows);
  const std::string title = title_of(run);
  draw_picture(layout.width, layout.height, title, path, [&](vtkContextScene& scene) {
    add_painted(scene, [&](vtkContext2D& painter) {
      paint_tints(painter, view, mesh, tints);
      paint_edges(painter, view, mesh, all_edges(mesh), black, small < 5.0F ? 0.5F : 1.0F);
      paint_edges(painter, view, mesh, region_edges(mesh), black, 2.5F);
      for (std::size_t b = 0; b < boundaries.size(); ++b) {
        paint_edges(painter, view, mesh, boundaries[b].faces, boundary_color(boundaries, b),
                    boundary_width);
      }
      if (shows_points) {
        paint_discs(painter, view, liquid, {blue}, small);
        paint_discs(painter, view, solid, {red}, double_point ? 1.6F * small : small);
      }
      view.paint_axes(painter);
      paint_text(painter, title, 24, static_cast<float>(layout.width) / 2.0F,
                 static_cast<float>(layout.height) - 36.0F);
    });
    vtkNew<ChartLegend> legend;
    legend->place(layout.legend_left, layout.legend_top, layout.legend_top, rows);
    scene.AddItem(legend);
  });
}

namespace {

/// The surface of a model: triangles in the colours of boundaries and regions.
SpaceDrawing sketched_surface(const PictureModel& model, const ModelView& view,
                              const std::vector<Color>& colors) {
  SpaceDrawing drawing;
  const auto at_node = [&](int node) { return space_pixel(view, model.projected(node)); };
  for (int t = 0; t < model.mesh.element_count(); ++t) {
    if (model.visible[t] == 0) continue;
    const auto& [a, b, c] = model.mesh.elements[t];
    drawing.add_triangle({at_node(a), at_node(b), at_node(c)}, {colors[t], colors[t], colors[t]});
  }
  const auto add_edges = [&](const Edges& edges, float width) {
    for (const auto& [i, j] : edges) drawing.add_line({at_node(i), at_node(j)}, black, width);
  };
  add_edges(model.all_edges, 0.5F);
  add_edges(model.outlines.regions, 2.0F);
  add_edges(model.outlines.outer, 2.0F);
  return drawing;
}

/// The colour of each triangle of the surface, and the legend's rows of boundaries.
std::vector<Color> surface_colors(const Mesh<3>& mesh, const Sheet& surface, const Scene& scene,
                                  const std::vector<RegionTint>& tints, std::vector<Curve>& rows) {
  std::map<std::array<int, 3>, Color> of_faces;
  const auto boundaries = sketched_boundaries(mesh, scene);
  for (std::size_t b = 0; b < boundaries.size(); ++b) {
    if (boundaries[b].label.ends_with("impervious")) {
      rows.push_back(line_row(boundaries[b].label + ", as the region", white, 0.0F));
      continue;
    }
    const Color color = boundary_color(boundaries, b);
    for (const auto& face : boundaries[b].faces) of_faces[face_key<3>(face)] = color;
    rows.push_back(marker_row(boundaries[b].label, color, Marker::square));
  }
  std::vector<Color> colors;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    std::array<int, 3> face{};
    for (int a = 0; a < 3; ++a) face.at(a) = surface.nodes[surface.triangles[t].at(a)].nodes[0];
    const auto found = of_faces.find(face_key<3>(face));
    const int region = mesh.element_region[surface.element[t]];
    colors.push_back(found == of_faces.end() ? tints[region].color : found->second);
  }
  return colors;
}

void draw_space_sketch(const ResultsReader& run, const std::string& path) {
  if (picture_format(path) != ".png") {
    throw InputError(InputProblem{"suffuse-post figure model", "-o", '"' + path + '"',
                                  "a .png for a model in space"});
  }
  const Mesh<3> mesh = run.mesh<3>();
  const Scene& scene = run.scene().scene;
  const Sheet surface = outer_sheet(mesh);
  const PictureModel model = space_model(mesh, surface, upward<3>(scene));
  const auto tints = region_tints(run, mesh);
  std::vector<Curve> rows;
  const auto colors = surface_colors(mesh, surface, scene, tints, rows);
  for (const auto& tint : tints) rows.push_back(tint_row(tint));
  const bool double_point = is_double_point(run);
  const std::string points = double_point ? "solid point" : "material point";
  rows.push_back(line_row(count_text(run.point_positions<3>(0, "solid").size(), points), white, 0));
  if (double_point) {
    const auto liquid = run.point_positions<3>(0, "liquid").size();
    rows.push_back(line_row(count_text(liquid, "liquid point"), white, 0.0F));
  }
  rows.push_back(line_row(count_text(mesh.elements.size(), "element"), black, 1.0F));
  const ModelView view(model.mesh, axes_left, axes_bottom, max_width, max_width);
  const float legend_left = view.left() + view.width() + 2.0F * legend_gap;
  const float shown = std::max(view.height(), legend_row * static_cast<float>(rows.size()));
  const auto width = static_cast<int>(legend_left + ChartLegend::width(rows) + legend_gap);
  const auto height = static_cast<int>(view.bottom() + shown + title_room);
  const SpaceDrawing drawing = sketched_surface(model, view, colors);
  const auto fill = [&](vtkContextScene& scene_of_picture) {
    add_painted(scene_of_picture, [&](vtkContext2D& painter) {
      paint_space_axes(painter, view, *model.space);
      paint_title(painter, title_of(run), width, height);
    });
    vtkNew<ChartLegend> legend;
    legend->place(legend_left, view.bottom() + shown, shown, rows);
    scene_of_picture.AddItem(legend);
  };
  draw_picture(width, height, title_of(run), path, fill, &drawing);
}

}  // namespace
}  // namespace suffuse

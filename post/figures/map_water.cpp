#include "figures/map_water.hpp"

#include <vtkBrush.h>
#include <vtkPen.h>

#include <algorithm>

#include "drawing/colored_triangles.hpp"
#include "drawing/line_labels.hpp"
#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"

namespace suffuse {
namespace {

constexpr Color water_blue{0.0, 0.27, 0.53};
constexpr Color water_tint{0.91, 0.96, 1.0};
constexpr float phreatic_width = 3.5F;
constexpr float level_width = 2.5F;
constexpr Color well_red{0.8, 0.0, 0.0};
constexpr float structure_width = 5.0F;
/// Width of the water next to an upright boundary, as a share of the model's larger extent.
constexpr double water_breadth = 0.08;

}  // namespace

std::vector<OutsideWater> water_outside(const ResultsReader& results, std::size_t index,
                                        const Mesh<2>& mesh, const std::array<int, 2>& axes) {
  const double breadth = water_breadth * extent(mesh).maxCoeff();
  Scene scene = results.scene().scene;
  const auto gravity = scene.gravity;
  scene.gravity = {gravity.at(axes[0]), gravity.at(axes[1]), 0.0};
  return outside_water(mesh, scene, results.times()[index], breadth);
}

ModelView view_with_water(const Mesh<2>& mesh, const std::vector<OutsideWater>& waters,
                          float bottom) {
  Vector<2> low = mesh.nodes.front();
  Vector<2> high = low;
  const auto include = [&](const Vector<2>& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  };
  for (const Vector<2>& node : mesh.nodes) include(node);
  for (const OutsideWater& water : waters) {
    for (const auto& corners : water.body) std::ranges::for_each(corners, include);
    std::ranges::for_each(water.level, include);
  }
  return {low, high, axes_left, bottom, PictureLayout::max_width, PictureLayout::max_height};
}

void paint_outside_water(vtkContext2D& painter, const ModelView& view,
                         const std::vector<OutsideWater>& waters) {
  if (waters.empty()) return;
  ColoredTriangles bodies;
  for (const OutsideWater& water : waters) {
    for (const auto& corners : water.body) {
      Polyline polygon;
      for (const Vector<2>& x : corners) polygon.push_back(view.pixel(x));
      bodies.add_polygon(polygon, water_tint);
    }
  }
  bodies.paint(painter);
  for (const OutsideWater& water : waters) {
    paint_polyline(painter, view, {water.level[0], water.level[1]}, water_blue, level_width);
    // The sign of a water level: a triangle that stands on it, and the head over it.
    const Vector<2> at = view.pixel(0.5 * (water.level[0] + water.level[1]));
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

std::vector<Polyline> phreatic_lines(const Mesh<2>& mesh, const std::vector<double>& pressure) {
  if (pressure.empty()) return {};
  const auto [low, high] = std::ranges::minmax(pressure);
  // Faces through which water seeps out have p = 0 up to round-off: the contour is taken slightly
  // below zero, so that the line does not run along them.
  return contour_lines(mesh, pressure, -1e-3 * (high - low));
}

void paint_phreatic_lines(vtkContext2D& painter, const ModelView& view,
                          const std::vector<Polyline>& lines) {
  paint_polylines(painter, view, lines, white, phreatic_width + 3.0F);
  paint_polylines(painter, view, lines, water_blue, phreatic_width);
}

Structures structures(const Mesh<2>& mesh, const Scene& scene) {
  Structures found;
  for (const auto& set : mesh.boundaries) {
    const auto is_this_well = [&](const BoundaryCondition& b) {
      return b.is_well() && b.on == set.name;
    };
    if (std::ranges::find(scene.walls, set.name, &Wall::on) != scene.walls.end()) {
      found.walls.insert(found.walls.end(), set.faces.begin(), set.faces.end());
    } else if (std::ranges::any_of(scene.boundaries, is_this_well)) {
      found.wells.insert(found.wells.end(), set.faces.begin(), set.faces.end());
    }
  }
  return found;
}

void paint_structures(vtkContext2D& painter, const ModelView& view, const Mesh<2>& mesh,
                      const Structures& structures) {
  for (const auto& [edges, color] :
       {std::pair{&structures.walls, black}, std::pair{&structures.wells, well_red}}) {
    paint_edges(painter, view, mesh, *edges, white, structure_width + 3.0F);
    paint_edges(painter, view, mesh, *edges, color, structure_width);
  }
}

void add_structure_legend(std::vector<Curve>& rows, const Structures& structures) {
  if (!structures.walls.empty()) rows.push_back(legend_line("wall", black, structure_width));
  if (!structures.wells.empty()) {
    rows.push_back(legend_line("well or drain", well_red, structure_width));
  }
}

Curve legend_line(const std::string& label, const Color& color, float width) {
  Curve row;
  row.label = label;
  row.color = color;
  row.width = width;
  return row;
}

void add_water_legend(std::vector<Curve>& rows, bool has_phreatic_line, bool has_outside_water) {
  if (has_phreatic_line) {
    rows.push_back(legend_line("phreatic line, p = 0", water_blue, phreatic_width));
  }
  if (has_outside_water) {
    rows.push_back(legend_line("water level outside, with its head", water_blue, level_width));
  }
}

}  // namespace suffuse

#include "drawing/model_view.hpp"

#include <vtkBrush.h>
#include <vtkMarkerUtilities.h>
#include <vtkPen.h>

#include <algorithm>
#include <cmath>

#include "drawing/color_map.hpp"
#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"
#include "drawing/type_size.hpp"
#include "mesh/faces.hpp"

namespace suffuse {
namespace {

constexpr float tick_length = 8.0F;
/// More discs than this are drawn in one call of VTK, which is faster; they are less round.
constexpr std::size_t max_round_discs = 20'000;

template <class Wanted>
Edges edges_where(const Mesh<2>& mesh, const Wanted& wanted) {
  Edges edges;
  for (const auto& [edge, elements] : elements_of_edges(mesh)) {
    if (wanted(elements)) edges.push_back(edge);
  }
  return edges;
}

}  // namespace

std::vector<double> ticks_within(double low, double high, double scale, double min_distance) {
  const double slack = 1e-9 * (high - low);
  std::vector<double> inside;
  for (const double tick : round_ticks(low, high)) {
    if (tick >= low - slack && tick <= high + slack) inside.push_back(tick);
  }
  const double spacing = inside.size() > 1 ? scale * (inside[1] - inside[0]) : min_distance;
  std::size_t every = 1;
  // Only every second, fifth or tenth tick is kept, so that the numbers stay round.
  for (const std::size_t factor : {2, 5, 10}) {
    if (static_cast<double>(every) * spacing < min_distance) every = factor;
  }
  if (every == 1) return inside;
  // Ticks are multiples of the wider step, so zero is a tick if it is in the interval.
  const double step = static_cast<double>(every) * (inside[1] - inside[0]);
  std::erase_if(inside, [&](double tick) { return std::abs(std::remainder(tick, step)) > slack; });
  return inside;
}

std::map<std::array<int, 2>, std::vector<int>> elements_of_edges(const Mesh<2>& mesh) {
  std::map<std::array<int, 2>, std::vector<int>> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int a = 0; a < 3; ++a) {
      elements[face_key<2>(face_opposite<2>(mesh.elements[e], a))].push_back(e);
    }
  }
  return elements;
}

ModelView::ModelView(const Mesh<2>& mesh, float left, float bottom, float max_width,
                     float max_height)
    : low_(mesh.nodes.front()), high_(low_), origin_(left, bottom) {
  for (const auto& node : mesh.nodes) {
    low_ = low_.cwiseMin(node);
    high_ = high_.cwiseMax(node);
  }
  fit(max_width, max_height);
}

ModelView::ModelView(const Vector<2>& low, const Vector<2>& high, float left, float bottom,
                     float max_width, float max_height)
    : low_(low), high_(high), origin_(left, bottom) {
  fit(max_width, max_height);
}

void ModelView::fit(float max_width, float max_height) {
  const Vector<2> size = high_ - low_;
  scale_ = std::min(max_width / size[0], max_height / size[1]);
}

bool ModelView::shows(const Vector<2>& middle, const Vector<2>& half) const {
  const Vector<2> first = middle - half - pixel(low_);
  const Vector<2> last = pixel(high_) - middle - half;
  return std::min(first.minCoeff(), last.minCoeff()) >= 0.0;
}

void ModelView::paint_axes(vtkContext2D& painter, const std::array<std::string, 2>& names) const {
  painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
  painter.GetPen()->SetColorF(0.0, 0.0, 0.0);
  painter.GetPen()->SetWidth(1.5F);
  for (const double tick : ticks_within(low_[0], high_[0], scale_, 60.0)) {
    const auto x = static_cast<float>(pixel({tick, low_[1]})[0]);
    painter.DrawLine(x, bottom() - 4.0F, x, bottom() - 4.0F - tick_length);
    paint_text(painter, tick_text(tick), font_size, x, bottom() - 28.0F);
  }
  for (const double tick : ticks_within(low_[1], high_[1], scale_, 40.0)) {
    const auto y = static_cast<float>(pixel({low_[0], tick})[1]);
    painter.DrawLine(left() - 4.0F, y, left() - 4.0F - tick_length, y);
    paint_text(painter, tick_text(tick), font_size, left() - 18.0F, y, Anchor::right);
  }
  paint_text(painter, names[0], 20, left() + width() / 2.0F, bottom() - 62.0F);
  paint_text(painter, names[1], 20, left() - 84.0F, bottom() + height() / 2.0F, Anchor::center,
             90.0);
}

void paint_title(vtkContext2D& painter, const std::string& title, int width, int height) {
  paint_text(painter, title, PictureLayout::title_size, static_cast<float>(width) / 2.0F,
             static_cast<float>(height) - 32.0F);
}

void paint_edges(vtkContext2D& painter, const ModelView& view, const Mesh<2>& mesh,
                 const Edges& edges, const Color& color, float width) {
  if (edges.empty()) return;
  std::vector<float> points;
  for (const auto& edge : edges) {
    for (const int node : edge) {
      const Vector<2> at = view.pixel(mesh.nodes[node]);
      points.push_back(static_cast<float>(at[0]));
      points.push_back(static_cast<float>(at[1]));
    }
  }
  painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
  painter.GetPen()->SetColorF(color[0], color[1], color[2]);
  painter.GetPen()->SetWidth(width);
  painter.DrawLines(points.data(), static_cast<int>(points.size() / 2));
}

Edges all_edges(const Mesh<2>& mesh) {
  return edges_where(mesh, [](const std::vector<int>&) { return true; });
}

Edges outer_edges(const Mesh<2>& mesh) {
  return edges_where(mesh, [](const std::vector<int>& elements) { return elements.size() == 1; });
}

Edges region_edges(const Mesh<2>& mesh) {
  return edges_where(mesh, [&](const std::vector<int>& elements) {
    return elements.size() == 2 &&
           mesh.element_region[elements[0]] != mesh.element_region[elements[1]];
  });
}

Outlines outlines(const Mesh<2>& mesh, const std::vector<bool>& is_open) {
  Outlines lines;
  for (const auto& [edge, elements] : elements_of_edges(mesh)) {
    const int region = mesh.element_region[elements.front()];
    const int other = mesh.element_region[elements.back()];
    if (elements.size() == 1) {
      (is_open[region] ? lines.open : lines.outer).push_back(edge);
    } else if (is_open[region] != is_open[other]) {
      lines.ground.push_back(edge);
    } else if (region != other && !is_open[region]) {
      lines.regions.push_back(edge);
    }
  }
  return lines;
}

void paint_discs(vtkContext2D& painter, const ModelView& view,
                 const std::vector<Vector<2>>& positions, const std::vector<Color>& colors,
                 float diameter) {
  if (positions.empty()) return;
  if (positions.size() <= max_round_discs) {
    painter.GetPen()->SetLineType(vtkPen::NO_PEN);
    for (std::size_t p = 0; p < positions.size(); ++p) {
      const Color& color = colors[colors.size() == 1 ? 0 : p];
      const Vector<2> at = view.pixel(positions[p]);
      painter.GetBrush()->SetColorF(color[0], color[1], color[2]);
      painter.DrawEllipse(static_cast<float>(at[0]), static_cast<float>(at[1]), diameter / 2.0F,
                          diameter / 2.0F);
    }
    painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
    return;
  }
  std::vector<float> points;
  std::vector<unsigned char> bytes;
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const Vector<2> at = view.pixel(positions[p]);
    points.push_back(static_cast<float>(at[0]));
    points.push_back(static_cast<float>(at[1]));
    for (const double part : colors[colors.size() == 1 ? 0 : p]) bytes.push_back(byte_of(part));
  }
  painter.GetPen()->SetWidth(diameter);
  painter.DrawMarkers(vtkMarkerUtilities::CIRCLE, false, points.data(),
                      static_cast<int>(positions.size()), bytes.data(), 3);
}

float disc_diameter(const ModelView& view, const Mesh<2>& mesh, std::size_t points) {
  double area = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) area += element_volume(mesh, e);
  const double distance =
      view.scale() * std::sqrt(area / static_cast<double>(std::max<std::size_t>(points, 1)));
  return static_cast<float>(std::clamp<double>(0.6 * distance, smallest_disc, 14.0));
}

}  // namespace suffuse

#include "figures/arrows.hpp"

#include <vtkPen.h>

#include <algorithm>
#include <cmath>

#include "drawing/colored_triangles.hpp"
#include "drawing/ticks.hpp"

namespace suffuse {
namespace {

/// Largest spacing of arrows, pixels; it is smaller in a low or narrow model.
constexpr double max_spacing = 42.0;
constexpr double min_spacing = 24.0;
/// Length of the longest arrow, as a share of the spacing.
constexpr double longest = 0.9;
/// Least length of an arrow, pixels: a shorter one shows no direction.
constexpr double shortest = 5.0;
constexpr double head_length = 9.0;

/// An arrow, pixels.
struct Shape {
  Vector<2> from;
  Vector<2> way;
};

/// Paints all arrows in one grey, widened by a margin. It needs few calls of VTK, which are slow in
/// SVG.
void paint_layer(vtkContext2D& painter, const std::vector<Shape>& shapes, double grey,
                 double margin) {
  std::vector<float> shafts;
  ColoredTriangles heads;
  for (const auto& [from, way] : shapes) {
    const double length = way.norm();
    const Vector<2> along = way / length;
    const Vector<2> across(-along[1], along[0]);
    const double head = std::min(head_length, 0.6 * length);
    const Vector<2> tip = from + way + 1.5 * margin * along;
    const Vector<2> foot = from + way - (head + 0.5 * margin) * along;
    for (const Vector<2>& x : {from, foot}) {
      shafts.insert(shafts.end(), {static_cast<float>(x[0]), static_cast<float>(x[1])});
    }
    const Vector<2> side = (0.4 * head + margin) * across;
    heads.add_polygon({tip, foot + side, foot - side}, {grey, grey, grey});
  }
  painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
  painter.GetPen()->SetColorF(grey, grey, grey);
  painter.GetPen()->SetWidth(static_cast<float>(1.6 + 2.0 * margin));
  painter.DrawLines(shafts.data(), static_cast<int>(shafts.size() / 2));
  heads.paint(painter);
}

/// Paints white beneath black, so that an arrow is seen on any colour.
void paint_arrows(vtkContext2D& painter, const std::vector<Shape>& shapes) {
  if (shapes.empty()) return;
  paint_layer(painter, shapes, 1.0, 1.2);
  paint_layer(painter, shapes, 0.0, 0.0);
}

double percentile_99(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + at);
  return values[at];
}

/// Whether a pixel lies in a triangle of pixels, in either order.
bool holds(const std::array<Vector<2>, 3>& corners, const Vector<2>& x) {
  const auto side = [&](int a) {
    const Vector<2> edge = corners.at((a + 1) % 3) - corners.at(a);
    const Vector<2> arm = x - corners.at(a);
    return edge[0] * arm[1] - edge[1] * arm[0];
  };
  const auto [least, largest] = std::minmax({side(0), side(1), side(2)});
  return least >= 0.0 || largest <= 0.0;
}

}  // namespace

Arrows::Arrows(const Mesh<2>& mesh, const std::vector<double>& vectors, const ModelView& view) {
  if (vectors.empty()) return;
  const double spacing =
      std::clamp(0.15 * std::min(view.width(), view.height()), min_spacing, max_spacing);
  longest_ = longest * spacing;
  const Vector<2> origin(view.left() + 0.5 * spacing, view.bottom() + 0.5 * spacing);
  const int columns = std::max(1, static_cast<int>(view.width() / spacing));
  const int rows = std::max(1, static_cast<int>(view.height() / spacing));
  std::vector<char> taken(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
  std::vector<double> sizes;
  for (int e = 0; e < mesh.element_count(); ++e) {
    std::array<Vector<2>, 3> corners;
    for (int a = 0; a < 3; ++a) corners.at(a) = view.pixel(mesh.nodes[mesh.elements[e][a]]);
    const Vector<2> low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]) - origin;
    const Vector<2> high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]) - origin;
    const auto at = 2 * static_cast<std::size_t>(e);
    for (int i = std::max(0, static_cast<int>(std::ceil(low[0] / spacing)));
         i < columns && i * spacing <= high[0]; ++i) {
      for (int j = std::max(0, static_cast<int>(std::ceil(low[1] / spacing)));
           j < rows && j * spacing <= high[1]; ++j) {
        const Vector<2> place = origin + spacing * Vector<2>(i, j);
        char& is_taken = taken[static_cast<std::size_t>(i) * static_cast<std::size_t>(rows) +
                               static_cast<std::size_t>(j)];
        if (is_taken != 0 || !holds(corners, place)) continue;
        is_taken = 1;
        arrows_.push_back({place, {vectors[at], vectors[at + 1]}});
        sizes.push_back(arrows_.back().vector.norm());
      }
    }
  }
  largest_ = percentile_99(std::move(sizes));
  if (largest_ > 0.0) reference_ = logarithmic_ticks(largest_, largest_).low;
}

Vector<2> Arrows::length_of(const Vector<2>& vector) const {
  const double size = vector.norm();
  if (!(size > 0.0)) return Vector<2>::Zero();
  return longest_ * std::min(1.0 / largest_, 1.0 / size) * vector;
}

void Arrows::paint(vtkContext2D& painter) const {
  std::vector<Shape> shapes;
  for (const Arrow& arrow : arrows_) {
    const Vector<2> way = length_of(arrow.vector);
    if (way.norm() >= shortest) shapes.push_back({arrow.middle - 0.5 * way, way});
  }
  paint_arrows(painter, shapes);
}

void Arrows::paint_reference(vtkContext2D& painter, float x, float y) const {
  if (largest_ > 0.0) paint_arrows(painter, {{{x, y}, length_of({reference_, 0.0})}});
}

}  // namespace suffuse

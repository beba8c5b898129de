#include "drawing/space.hpp"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "drawing/color_map.hpp"
#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"

namespace suffuse {
namespace {

/// Lines are moved towards the viewer, in front of triangles, by this many pixels, and by as much
/// again for each pixel of width, so that wide lines lie over narrow ones.
constexpr double line_lift = 2.0;
constexpr double tick_length_in_space = 9.0;
constexpr double label_distance = 24.0;
constexpr double name_distance = 74.0;

/// Points with a colour each, and the cells that join them.
struct Cells {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colors;

  Cells() { colors->SetNumberOfComponents(3); }
  void add(const Vector<3>& x, const Color& color) {
    cells->InsertCellPoint(points->InsertNextPoint(x.data()));
    const unsigned char bytes[3] = {byte_of(color[0]), byte_of(color[1]), byte_of(color[2])};
    colors->InsertNextTypedTuple(bytes);
  }
};

void add_actor(vtkRenderer& renderer, const Cells& cells, float line_width) {
  vtkNew<vtkPolyData> data;
  data->SetPoints(cells.points);
  if (line_width > 0.0F) {
    data->SetLines(cells.cells);
  } else {
    data->SetPolys(cells.cells);
  }
  data->GetPointData()->SetScalars(cells.colors);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  if (line_width > 0.0F) actor->GetProperty()->SetLineWidth(line_width);
  renderer.AddActor(actor);
}

/// An edge of the box that carries an axis, and in which direction its labels lie.
struct Axis {
  int along;
  Vector<3> start;
  Vector<3> outward;
};

/// Edges at the lower front, the lower side that is seen, and the other end of the front.
std::array<Axis, 3> axes_of(const SpaceBox& box) {
  int vertical = 0;
  box.view.up.cwiseAbs().maxCoeff(&vertical);
  const int depth = vertical == 2 ? 1 : 2;
  const int across = 3 - vertical - depth;
  Vector<3> front = box.low;
  if (box.view.toward[depth] > 0.0) front[depth] = box.high[depth];
  const bool right_is_seen = box.view.toward[across] > 0.0;
  const Vector<3> aside = Vector<3>::Unit(across) * (right_is_seen ? 1.0 : -1.0);
  front[across] = right_is_seen ? box.low[across] : box.high[across];
  Vector<3> side = front;
  side[across] = right_is_seen ? box.high[across] : box.low[across];
  const Vector<3> forward = Vector<3>::Unit(depth) * (box.view.toward[depth] > 0.0 ? 1.0 : -1.0);
  return {Axis{across, front, forward}, Axis{depth, side, aside}, Axis{vertical, front, -aside}};
}

void paint_axis(vtkContext2D& painter, const ModelView& paper, const SpaceBox& box,
                const Axis& axis) {
  constexpr std::array<const char*, 3> names{"x (m)", "y (m)", "z (m)"};
  const auto on_paper = [&](const Vector<3>& x) { return box.view.project(x).head<2>().eval(); };
  const Vector<2> outward = on_paper(axis.outward).normalized();
  const double scale = paper.scale() * on_paper(Vector<3>::Unit(axis.along)).norm();
  constexpr double shortest_axis = 20.0;  // pixels
  if (scale * (box.high - box.low)[axis.along] < shortest_axis) return;
  const auto at = [&](double value, double distance) {
    Vector<3> x = axis.start;
    x[axis.along] = value;
    return Vector<2>(paper.pixel(on_paper(x)) + distance * outward);
  };
  const auto text = [&](const std::string& what, int size, const Vector<2>& x) {
    paint_text(painter, what, size, static_cast<float>(x[0]), static_cast<float>(x[1]));
  };
  const double low = box.low[axis.along];
  const double high = box.high[axis.along];
  for (const double tick : ticks_within(low, high, scale, 45.0)) {
    const Vector<2> from = at(tick, 3.0);
    const Vector<2> to = at(tick, 3.0 + tick_length_in_space);
    painter.DrawLine(static_cast<float>(from[0]), static_cast<float>(from[1]),
                     static_cast<float>(to[0]), static_cast<float>(to[1]));
    text(tick_text(tick), 18, at(tick, label_distance));
  }
  text(names.at(axis.along), 20, at(0.5 * (low + high), name_distance));
}

}  // namespace

SpaceView space_view(const Vector<3>& upward, const Camera& camera) {
  const Vector<3> x = Vector<3>::UnitX();
  const bool lies = std::abs(upward.dot(x)) > 0.5;
  const Vector<3> across = lies ? Vector<3>::UnitY().eval() : x;
  const Vector<3> forward = across.cross(upward);
  constexpr double degree = std::numbers::pi / 180.0;
  const double azimuth = degree * camera.azimuth;
  const double elevation = degree * camera.elevation;
  const Vector<3> level = std::sin(azimuth) * across + std::cos(azimuth) * forward;
  const Vector<3> toward = std::cos(elevation) * level + std::sin(elevation) * upward;
  const Vector<3> right = upward.cross(toward).normalized();
  return {right, toward.cross(right), toward};
}

void paint_space_axes(vtkContext2D& painter, const ModelView& paper, const SpaceBox& box) {
  painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
  painter.GetPen()->SetColorF(0.0, 0.0, 0.0);
  painter.GetPen()->SetWidth(1.5F);
  for (const Axis& axis : axes_of(box)) paint_axis(painter, paper, box, axis);
}

void SpaceDrawing::add_triangle(const std::array<Vector<3>, 3>& corners,
                                const std::array<Color, 3>& colors) {
  triangles_.push_back({corners, colors});
}

void SpaceDrawing::add_line(const std::array<Vector<3>, 2>& ends, const Color& color, float width) {
  lines_.push_back({ends, color, width});
}

void SpaceDrawing::add_to(vtkRenderer& renderer, int width, int height) const {
  Cells areas;
  double near = 0.0;
  double far = 0.0;
  const auto reach = [&](const Vector<3>& x) {
    near = std::max(near, x[2]);
    far = std::min(far, x[2]);
  };
  for (const auto& [corners, colors] : triangles_) {
    areas.cells->InsertNextCell(3);
    for (int a = 0; a < 3; ++a) {
      areas.add(corners.at(a), colors.at(a));
      reach(corners.at(a));
    }
  }
  add_actor(renderer, areas, 0.0F);
  std::map<float, Cells> lines;
  for (const auto& [ends, color, line_width] : lines_) {
    Cells& cells = lines[line_width];
    cells.cells->InsertNextCell(2);
    for (const Vector<3>& x : ends) {
      cells.add(x + Vector<3>(0.0, 0.0, line_lift * (1.0 + line_width)), color);
      reach(x);
    }
  }
  for (const auto& [line_width, cells] : lines) add_actor(renderer, cells, line_width);
  // A unit of the scene is a pixel.
  vtkCamera& camera = *renderer.GetActiveCamera();
  const double x = 0.5 * width;
  const double y = 0.5 * height;
  const double distance = near - far + 10.0;
  camera.ParallelProjectionOn();
  camera.SetFocalPoint(x, y, near);
  camera.SetPosition(x, y, near + distance);
  camera.SetViewUp(0.0, 1.0, 0.0);
  camera.SetParallelScale(y);
  camera.SetClippingRange(0.5 * distance, 2.5 * distance);
}

}  // namespace suffuse

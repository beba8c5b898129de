#pragma once

/// Three-dimensional models on paper: a parallel view, and what
/// is drawn in it, hidden where something lies in front.

#include <vtkRenderer.h>

#include <array>
#include <vector>

#include "drawing/model_view.hpp"

namespace suffuse {

/// A parallel projection: coordinates on the paper and towards the viewer, m.
struct SpaceView {
  Vector<3> right;
  Vector<3> up;
  Vector<3> toward;

  [[nodiscard]] Vector<3> project(const Vector<3>& x) const {
    return {right.dot(x), up.dot(x), toward.dot(x)};
  }
};
/// From where a model is seen, degrees.
struct Camera {
  double azimuth = 31.0;    ///< from the front to the right
  double elevation = 28.8;  ///< above the horizon
};
/// The projection in which `upward`, an axis of the model, points upwards. From the front x goes to
/// the right.
SpaceView space_view(const Vector<3>& upward, const Camera& camera = {});

/// The box around a model, whose edges carry the axes.
struct SpaceBox {
  SpaceView view;
  Vector<3> low;
  Vector<3> high;
};
/// Paints ticks and labels in metres at three edges of the box; `paper` maps projected metres.
void paint_space_axes(vtkContext2D& painter, const ModelView& paper, const SpaceBox& box);

/// Pixels of a projected place, the third towards the viewer.
inline Vector<3> space_pixel(const ModelView& paper, const Vector<3>& projected) {
  const Vector<2> at = paper.pixel(projected.head<2>());
  return {at[0], at[1], paper.scale() * projected[2]};
}

/// Triangles and lines of one picture, in pixels; the third coordinate counts towards the viewer.
class SpaceDrawing {
 public:
  void add_triangle(const std::array<Vector<3>, 3>& corners, const std::array<Color, 3>& colors);
  /// A line lies a little in front of a triangle at its place.
  void add_line(const std::array<Vector<3>, 2>& ends, const Color& color, float width);
  /// Adds the drawing to a picture of `width` by `height` pixels.
  void add_to(vtkRenderer& renderer, int width, int height) const;

 private:
  struct Triangle {
    std::array<Vector<3>, 3> corners;
    std::array<Color, 3> colors;
  };
  struct Line {
    std::array<Vector<3>, 2> ends;
    Color color;
    float width;
  };
  std::vector<Triangle> triangles_;
  std::vector<Line> lines_;
};

}  // namespace suffuse

#include "drawing/colored_triangles.hpp"
#include "drawing/color_map.hpp"

#include <vtkMapper.h>
#include <vtkOpenGLGL2PSHelper.h>
#include <vtkPath.h>

#include <cmath>
#include <map>

namespace suffuse {

ColoredTriangles::ColoredTriangles() {
  colors_->SetNumberOfComponents(4);
}

void ColoredTriangles::add(const std::array<Vector<2>, 3>& corners,
                           const std::array<Color, 3>& colors) {
  triangles_->InsertNextCell(3);
  for (int a = 0; a < 3; ++a) {
    triangles_->InsertCellPoint(points_->InsertNextPoint(corners.at(a)[0], corners.at(a)[1], 0.0));
    const auto& color = colors.at(a);
    const unsigned char bytes[4] = {byte_of(color[0]), byte_of(color[1]), byte_of(color[2]), 255};
    colors_->InsertNextTypedTuple(bytes);
  }
}

void ColoredTriangles::add_polygon(const std::vector<Vector<2>>& corners, const Color& color) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    add({corners[0], corners[i], corners[i + 1]}, {color, color, color});
  }
}

void ColoredTriangles::write_paths(vtkOpenGLGL2PSHelper& file) const {
  std::map<std::array<unsigned char, 3>, vtkNew<vtkPath>> paths;
  for (vtkIdType i = 0; i < points_->GetNumberOfPoints(); i += 3) {
    std::array<unsigned char, 3> color{};
    for (int k = 0; k < 3; ++k) {
      double sum = 0.0;
      for (int a = 0; a < 3; ++a) sum += colors_->GetComponent(i + a, k);
      color.at(k) = static_cast<unsigned char>(std::lround(sum / 3.0));
    }
    vtkPath& path = *paths[color];
    for (int a = 0; a < 4; ++a) {
      double x[3];
      points_->GetPoint(i + a % 3, x);
      path.InsertNextPoint(x, a == 0 ? vtkPath::MOVE_TO : vtkPath::LINE_TO);
    }
  }
  double origin[3] = {0.0, 0.0, 0.0};
  // Outlines come first: viewers smooth the edges of areas, so white would show between two.
  constexpr float outline = 0.8F;
  constexpr float filled = 0.0F;
  for (const float stroke : {outline, filled}) {
    for (const auto& [color, path] : paths) {
      unsigned char rgba[4] = {color[0], color[1], color[2], 255};
      file.DrawPath(path, origin, origin, rgba, nullptr, 0.0, stroke);
    }
  }
}

void ColoredTriangles::paint(vtkContext2D& painter) {
  if (auto* file = vtkOpenGLGL2PSHelper::GetInstance()) {
    if (file->GetActiveState() == vtkOpenGLGL2PSHelper::Capture) write_paths(*file);
    return;
  }
  grid_->SetPoints(points_);
  grid_->SetPolys(triangles_);
  painter.DrawPolyData(0.0F, 0.0F, grid_, colors_, VTK_SCALAR_MODE_USE_POINT_DATA);
}

}  // namespace suffuse

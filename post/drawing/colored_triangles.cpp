#include "drawing/colored_triangles.hpp"

#include <vtkMapper.h>

#include <cmath>

namespace suffuse {
namespace {

unsigned char byte_of(double value) {
  return static_cast<unsigned char>(std::lround(255.0 * value));
}

}  // namespace

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

void ColoredTriangles::paint(vtkContext2D& painter) {
  grid_->SetPoints(points_);
  grid_->SetPolys(triangles_);
  painter.DrawPolyData(0.0F, 0.0F, grid_, colors_, VTK_SCALAR_MODE_USE_POINT_DATA);
}

}  // namespace suffuse

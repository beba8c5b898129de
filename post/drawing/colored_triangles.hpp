#pragma once

/// Triangles with a colour at each corner, painted in one call of VTK.

#include <vtkCellArray.h>
#include <vtkContext2D.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include "case/mesh.hpp"
#include "drawing/chart.hpp"

namespace suffuse {

class ColoredTriangles {
 public:
  ColoredTriangles();
  /// Corners in pixels.
  void add(const std::array<Vector<2>, 3>& corners, const std::array<Color, 3>& colors);
  void paint(vtkContext2D& painter);

 private:
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> triangles_;
  vtkNew<vtkPolyData> grid_;
  vtkNew<vtkUnsignedCharArray> colors_;
};

}  // namespace suffuse

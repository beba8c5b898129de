#pragma once

/// Triangles with a colour at each corner, painted in one call of VTK. VTK leaves them out of SVG
/// and PDF: there each triangle has one colour, and triangles of equal colour form one path.

#include <vtkCellArray.h>
#include <vtkContext2D.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <array>
#include <vector>

#include "drawing/chart.hpp"
#include "mesh/mesh.hpp"

class vtkOpenGLGL2PSHelper;

namespace suffuse {

class ColoredTriangles {
 public:
  ColoredTriangles();
  /// Corners in pixels.
  void add(const std::array<Vector<2>, 3>& corners, const std::array<Color, 3>& colors);
  /// A convex polygon of one colour, corners in pixels.
  void add_polygon(const std::vector<Vector<2>>& corners, const Color& color);
  void paint(vtkContext2D& painter);

 private:
  void write_paths(vtkOpenGLGL2PSHelper& file) const;

  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> triangles_;
  vtkNew<vtkPolyData> grid_;
  vtkNew<vtkUnsignedCharArray> colors_;
};

}  // namespace suffuse

#pragma once

/// The legend beside a chart. VTK's own shows a line as 25 pixels, too short to tell dashes apart.

#include <vtkContextItem.h>
#include <vtkSmartPointer.h>

#include "chart.hpp"

namespace suffuse {

/// VTK's number for a pen.
int vtk_line_type(Dash dash);

/// One of the shapes that make a marker, the lowest first.
struct MarkerLayer {
  int shape;   ///< VTK's number
  float size;  ///< pixels
  bool white;  ///< or else in the colour of the curve
};
std::vector<MarkerLayer> marker_layers(const Curve& curve);

class ChartLegend : public vtkContextItem {
 public:
  static ChartLegend* New();

  /// Top left corner in pixels from the bottom left of the picture, the height there is, and the
  /// rows to show. Many rows move closer together.
  void place(float left, float top, float height, const std::vector<Curve>& curves);
  /// Pixels that these rows are wide.
  static float width(const std::vector<Curve>& curves);

  bool Paint(vtkContext2D* painter) override;

 private:
  float left_ = 0.0F;
  float top_ = 0.0F;
  float row_height_ = 0.0F;
  std::vector<Curve> rows_;
};

}  // namespace suffuse

#pragma once

/// The legend next to a chart: a row for each label, with its line or marker. VTK's own legend
/// draws lines of 25 pixels, too short to tell dashes apart.

#include <vtkContextItem.h>
#include <vtkSmartPointer.h>

#include "drawing/chart.hpp"

namespace suffuse {

/// VTK's line type of a pen (vtkPen).
int vtk_line_type(Dash dash);

/// One of the shapes painted over one another that make a marker.
struct MarkerLayer {
  int shape;   ///< style of vtkMarkerUtilities
  float size;  ///< pixels
  bool white;  ///< otherwise in the colour of the curve
};
/// The shapes of a curve's marker, the lowest first.
std::vector<MarkerLayer> marker_layers(const Curve& curve);

/// A VTK item that paints the legend.
class ChartLegend : public vtkContextItem {
 public:
  static ChartLegend* New();

  /// Sets the top left corner (pixels from the bottom left of the picture), the height available
  /// and the rows: the curves that have a label. Rows move closer where the height is too small.
  void place(float left, float top, float height, const std::vector<Curve>& curves);
  /// Height of the rows in pixels, once placed.
  [[nodiscard]] float height() const { return row_height_ * static_cast<float>(rows_.size()); }
  /// Width of the rows in pixels.
  static float width(const std::vector<Curve>& curves);

  bool Paint(vtkContext2D* painter) override;

 private:
  float left_ = 0.0F;
  float top_ = 0.0F;
  float row_height_ = 0.0F;
  std::vector<Curve> rows_;
};

}  // namespace suffuse

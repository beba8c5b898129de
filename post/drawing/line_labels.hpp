#pragma once

/// Lines on a map, and labels on them that hide neither one another nor other lines.

#include <vtkContext2D.h>

#include <string>
#include <vector>

#include "drawing/contours.hpp"
#include "drawing/model_view.hpp"

namespace suffuse {

/// Paints a line whose places are in metres; `width` in pixels.
void paint_polyline(vtkContext2D& painter, const ModelView& view, const Polyline& line,
                    const Color& color, float width);
/// Paints several lines of one colour and width.
void paint_polylines(vtkContext2D& painter, const ModelView& view,
                     const std::vector<Polyline>& lines, const Color& color, float width);
/// Paints lines on a coloured map, with an edge of another colour, 1 pixel wide.
void paint_edged_polylines(vtkContext2D& painter, const ModelView& view,
                           const std::vector<Polyline>& lines, const Color& color,
                           const Color& edge, float width);

/// The labels of a map, each on white ground.
class LineLabels {
 public:
  explicit LineLabels(const ModelView& view) : view_(view) {}
  /// No label hides these lines.
  void avoid(const std::vector<Polyline>& lines);
  /// Labels the longest of the lines, where there is room.
  void paint(vtkContext2D& painter, const std::vector<Polyline>& lines, const std::string& text);

 private:
  /// A rectangle that is occupied, pixels.
  struct Box {
    Vector<2> middle;
    Vector<2> half;
  };
  [[nodiscard]] bool is_free(const Box& box) const;

  const ModelView& view_;
  std::vector<Box> taken_;
};

/// A field, and the levels at which its contours are drawn.
struct ContourField {
  const Mesh<2>& mesh;
  const std::vector<double>& at_nodes;
  const std::vector<double>& levels;
};
struct LineStyle {
  Color color;
  float width;  ///< pixels
};

/// Contour lines of a level, which is shifted by a millionth of the range of the field away from
/// its middle: boundaries often have a round value up to round-off, and no line may run along them.
std::vector<Polyline> level_lines(const ContourField& field, double level);

/// Paints contours at all levels, then their values.
void paint_contours(vtkContext2D& painter, const ModelView& view, const ContourField& field,
                    const LineStyle& style, LineLabels& labels);

}  // namespace suffuse

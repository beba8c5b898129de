#pragma once

/// A mesh on paper: where metres become pixels, and what render and the model sketch paint alike.

#include <vtkContext2D.h>

#include <vector>

#include "case/mesh.hpp"
#include "chart.hpp"

namespace suffuse {

/// Equal scales on both axes. Pixels count from the bottom left of the picture.
class ModelView {
 public:
  /// Fits the mesh into a box whose lower left corner is there, keeping to its left and bottom.
  ModelView(const Mesh<2>& mesh, float left, float bottom, float largest_width,
            float largest_height);

  [[nodiscard]] Vector<2> pixel(const Vector<2>& x) const { return origin_ + scale_ * (x - low_); }
  [[nodiscard]] float left() const { return static_cast<float>(origin_[0]); }
  [[nodiscard]] float bottom() const { return static_cast<float>(origin_[1]); }
  [[nodiscard]] float width() const { return static_cast<float>(scale_ * (high_ - low_)[0]); }
  [[nodiscard]] float height() const { return static_cast<float>(scale_ * (high_ - low_)[1]); }
  /// Pixels per metre.
  [[nodiscard]] double scale() const { return scale_; }

  /// Ticks and labels in metres at the left and below.
  void paint_axes(vtkContext2D& painter) const;

 private:
  Vector<2> low_;
  Vector<2> high_;
  Vector<2> origin_;
  double scale_ = 1.0;
};

/// Room that the axes need at the left and below, pixels.
inline constexpr float axes_left = 110.0F;
inline constexpr float axes_bottom = 90.0F;

/// Lines of `width` pixels between pairs of nodes.
using Edges = std::vector<std::array<int, 2>>;
void paint_edges(vtkContext2D& painter, const ModelView& view, const Mesh<2>& mesh,
                 const Edges& edges, const Color& color, float width);

/// Every edge of the mesh once, in ascending order.
Edges all_edges(const Mesh<2>& mesh);
/// Edges that belong to one element only.
Edges outer_edges(const Mesh<2>& mesh);
/// Edges between elements of two regions.
Edges region_edges(const Mesh<2>& mesh);

/// Discs of `diameter` pixels, one colour each or one for all.
void paint_discs(vtkContext2D& painter, const ModelView& view,
                 const std::vector<Vector<2>>& positions, const std::vector<Color>& colors,
                 float diameter);

/// A diameter at which that many points on the whole mesh stay apart, pixels.
float disc_diameter(const ModelView& view, const Mesh<2>& mesh, std::size_t points);

}  // namespace suffuse

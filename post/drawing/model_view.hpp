#pragma once

/// The mapping of a mesh from metres to pixels, and painters of axes, edges and discs in it, for
/// render and the model sketch.

#include <vtkContext2D.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "drawing/chart.hpp"
#include "mesh/mesh.hpp"

namespace suffuse {

/// Layout of a picture of the model with a colour bar, pixels.
struct PictureLayout {
  static constexpr float max_width = 1000.0F;  ///< largest size of the model
  static constexpr float max_height = 800.0F;
  static constexpr float gap = 40.0F;  ///< between the model and the bar
  static constexpr float bar_width = 30.0F;
  static constexpr float min_bar_height = 340.0F;  ///< the bar of a lower map lies below it
  static constexpr int title_size = 24;

  /// Width of a picture that holds the title with room at both sides, pixels.
  static float title_width(const std::string& title) {
    constexpr float letter = 14.0F;
    return letter * static_cast<float>(title.size()) + 2.0F * gap;
  }
};

/// Paints the title of a picture of this size.
void paint_title(vtkContext2D& painter, const std::string& title, int width, int height);

/// Maps positions in metres to pixels, with one scale for both axes. Pixels count from the bottom
/// left of the picture.
class ModelView {
 public:
  /// Fits the mesh into a box with lower left corner (left, bottom) and the given largest size; the
  /// mesh touches the left and bottom sides. All in pixels.
  ModelView(const Mesh<2>& mesh, float left, float bottom, float max_width, float max_height);
  /// Fits the rectangle with corners `low` and `high`, m, into such a box.
  ModelView(const Vector<2>& low, const Vector<2>& high, float left, float bottom, float max_width,
            float max_height);

  [[nodiscard]] Vector<2> pixel(const Vector<2>& x) const { return origin_ + scale_ * (x - low_); }
  [[nodiscard]] float left() const { return static_cast<float>(origin_[0]); }
  [[nodiscard]] float bottom() const { return static_cast<float>(origin_[1]); }
  [[nodiscard]] float width() const { return static_cast<float>(scale_ * (high_ - low_)[0]); }
  [[nodiscard]] float height() const { return static_cast<float>(scale_ * (high_ - low_)[1]); }
  /// Whether all of a rectangle is in view, with its middle and half its size in pixels.
  [[nodiscard]] bool shows(const Vector<2>& middle, const Vector<2>& half) const;
  /// Corners of the view, m.
  [[nodiscard]] const Vector<2>& low() const { return low_; }
  [[nodiscard]] const Vector<2>& high() const { return high_; }
  /// Pixels per metre.
  [[nodiscard]] double scale() const { return scale_; }

  /// Paints ticks and labels in metres to the left of the mesh and below.
  void paint_axes(vtkContext2D& painter,
                  const std::array<std::string, 2>& names = {"x (m)", "y (m)"}) const;

 private:
  void fit(float max_width, float max_height);

  Vector<2> low_;
  Vector<2> high_;
  Vector<2> origin_;
  double scale_ = 1.0;
};

/// Round numbers within [low, high] that are at least `min_distance` pixels apart; `scale`: pixels
/// per unit.
std::vector<double> ticks_within(double low, double high, double scale, double min_distance);

/// Room for the axes to the left of the mesh and below, pixels.
inline constexpr float axes_left = 110.0F;
inline constexpr float axes_bottom = 90.0F;

/// Pairs of nodes.
using Edges = std::vector<std::array<int, 2>>;
/// Paints lines of `width` pixels.
void paint_edges(vtkContext2D& painter, const ModelView& view, const Mesh<2>& mesh,
                 const Edges& edges, const Color& color, float width);

/// The one or two elements of each edge.
std::map<std::array<int, 2>, std::vector<int>> elements_of_edges(const Mesh<2>& mesh);

/// Every edge of the mesh, sorted.
Edges all_edges(const Mesh<2>& mesh);
/// Edges on the outer boundary: those of one element only.
Edges outer_edges(const Mesh<2>& mesh);
/// Edges between elements of two regions.
Edges region_edges(const Mesh<2>& mesh);

/// The outlines of a model whose regions may be without soil.
struct Outlines {
  Edges outer;    ///< of soil, on the outer boundary
  Edges regions;  ///< between soils
  Edges ground;   ///< between soil and what is without soil
  Edges open;     ///< of what is without soil, on the outer boundary
};
/// `is_open`: per region, whether it is without soil.
Outlines outlines(const Mesh<2>& mesh, const std::vector<bool>& is_open);

/// Paints discs of `diameter` pixels; `colors` has one colour per disc, or one for all.
void paint_discs(vtkContext2D& painter, const ModelView& view,
                 const std::vector<Vector<2>>& positions, const std::vector<Color>& colors,
                 float diameter);

/// Smallest diameter of a disc, pixels; `disc_diameter` returns it where points are too dense.
constexpr float smallest_disc = 2.0F;

/// A diameter in pixels at which discs do not touch when `points` of them are spread over the mesh.
float disc_diameter(const ModelView& view, const Mesh<2>& mesh, std::size_t points);

}  // namespace suffuse

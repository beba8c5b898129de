#pragma once

/// Arrows of a vector field on a regular grid of places.

#include <vtkContext2D.h>

#include <vector>

#include "drawing/model_view.hpp"

namespace suffuse {

/// Arrows as long as the vectors are large, up to the 99th percentile; longer ones are cut to that.
class Arrows {
 public:
  /// `vectors`: two components per element, or none. One arrow at each place of a grid over the
  /// view that lies in an element.
  Arrows(const Mesh<2>& mesh, const std::vector<double>& vectors, const ModelView& view);

  void paint(vtkContext2D& painter) const;
  /// The arrow of a legend: from (x, y) to the right.
  void paint_reference(vtkContext2D& painter, float x, float y) const;
  /// Magnitude that this arrow stands for: 1, 2 or 5 times a power of ten; 0 if all vectors are 0.
  [[nodiscard]] double reference() const { return reference_; }

 private:
  struct Arrow {
    Vector<2> middle;  ///< pixels
    Vector<2> vector;
  };
  /// A vector in pixels.
  [[nodiscard]] Vector<2> length_of(const Vector<2>& vector) const;

  std::vector<Arrow> arrows_;
  double longest_ = 0.0;  ///< arrow, pixels
  double largest_ = 0.0;  ///< largest vector that is not cut
  double reference_ = 0.0;
};

}  // namespace suffuse

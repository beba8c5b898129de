#pragma once

/// Vertical lines through the soil, from the ground down.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Whether water can leave through a boundary or a well.
bool lets_water_out(const BoundaryCondition& condition);

/// The part of a vertical line in one element.
template <int Dim>
struct LineSegment {
  int element = 0;
  double length = 0.0;                       ///< m
  std::array<double, Dim + 1> top_weights;   ///< barycentric coordinates of its upper end
  std::array<double, Dim + 1> base_weights;  ///< barycentric coordinates of its lower end
};

/// Segments of a vertical line that follow each other, in order.
template <int Dim>
using LinePart = std::span<const LineSegment<Dim>>;

/// Length of a part of a line, m.
template <int Dim>
double length_of(LinePart<Dim> part);

/// A place on the ground: a face of soil that looks up, with no soil above it. Walls and wells
/// inside the soil are no ground; lines cross them.
template <int Dim>
struct GroundPlace {
  int element = 0;
  Vector<Dim> position;                 ///< m
  std::array<double, Dim + 1> weights;  ///< barycentric coordinates
  Vector<Dim> outward;                  ///< normal of the face, of any length
  std::string boundary{};               ///< empty: the face is part of none
  bool bears_water = false;             ///< water of a known pressure can stand on it
  bool lets_water_out = false;          ///< impervious ground and walls do not
};

template <int Dim>
class VerticalLines {
 public:
  VerticalLines(const Mesh<Dim>& mesh, const Scene& scene);

  /// The middle of each face of the ground.
  [[nodiscard]] const std::vector<GroundPlace<Dim>>& ground() const { return ground_; }
  /// The highest ground at x, m; nothing where there is none. Where two faces meet at x, `side` of
  /// 1 or -1 takes the one towards larger or smaller x. In two dimensions.
  [[nodiscard]] std::optional<GroundPlace<Dim>> ground_at(double x, double side = 0.0) const;
  /// The line from a place on the ground down to the end of the soil, in order.
  [[nodiscard]] std::vector<LineSegment<Dim>> below(const GroundPlace<Dim>& place) const;
  /// The highest layer of a region on a line. It ends at the first soil of another region, even
  /// if the region lies below that soil too. Empty if the line does not cross the region.
  [[nodiscard]] LinePart<Dim> highest_layer(LinePart<Dim> line, const std::string& region) const;
  /// The lowest layer of a region on a line.
  [[nodiscard]] LinePart<Dim> lowest_layer(LinePart<Dim> line, const std::string& region) const;
  [[nodiscard]] const std::string& region_of(int element) const {
    return mesh_.region_names[mesh_.element_region[element]];
  }

 private:
  [[nodiscard]] bool is_soil(int element) const;
  /// The element behind the face opposite to a corner; -1 if there is none.
  [[nodiscard]] int neighbour(int element, int corner) const {
    return neighbours_[element][corner];
  }
  void find_neighbours();
  void find_ground();
  void add_ground(int element, int corner, const BoundaryCondition* condition);

  const Mesh<Dim>& mesh_;
  const Scene& scene_;
  Vector<Dim> up_;
  std::vector<std::array<int, Dim + 1>> neighbours_;
  std::vector<GroundPlace<Dim>> ground_;
};

}  // namespace suffuse

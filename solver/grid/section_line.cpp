#include "grid/section_line.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ranks/exact_sum.hpp"

namespace suffuse {
namespace {

/// A place outside an element by less than this, in barycentric coordinates, is on its boundary.
constexpr double on_boundary = 1e-9;

/// The coordinates of both ends of a line in an element that the line may touch.
struct Candidate {
  long element;  ///< number in the whole mesh
  std::array<double, 3> from;
  std::array<double, 3> to;

  /// The smallest coordinate at a share of the line.
  [[nodiscard]] double depth(double share) const {
    double least = 1.0;
    for (int k = 0; k < 3; ++k) {
      least = std::min(least, from[k] + share * (to[k] - from[k]));
    }
    return least;
  }
  /// Whether a piece of the line is in the element or runs along its boundary, by the depth of its
  /// middle. Short pieces that lead away from the boundary do neither.
  [[nodiscard]] bool holds(double middle, double part) const {
    constexpr double along = 1e-3;
    double passed = 0.0;
    for (int k = 0; k < 3; ++k) passed = std::max(passed, part * std::abs(to[k] - from[k]));
    return depth(middle) >= -std::min(on_boundary, along * passed);
  }
  /// Whether the line comes within `on_boundary` of the element.
  [[nodiscard]] bool touches() const {
    double begin = 0.0;
    double end = 1.0;
    for (int k = 0; k < 3; ++k) {
      const double a = from[k] + on_boundary;
      const double b = to[k] + on_boundary;
      if (a < 0.0 && b < 0.0) return false;
      if (a < 0.0) begin = std::max(begin, a / (a - b));
      if (b < 0.0) end = std::min(end, a / (a - b));
    }
    return begin <= end;
  }
};

/// Shares of the line at which it crosses the sides of elements, ascending, both ends included.
std::vector<double> crossing_shares(const std::vector<Candidate>& candidates) {
  std::vector<double> shares{0.0, 1.0};
  for (const Candidate& c : candidates) {
    for (int k = 0; k < 3; ++k) {
      if ((c.from[k] < 0.0) == (c.to[k] < 0.0)) continue;
      shares.push_back(c.from[k] / (c.from[k] - c.to[k]));
    }
  }
  std::ranges::sort(shares);
  return shares;
}

}  // namespace

template <int Dim>
std::optional<PointPlace<Dim>> find_place(const Grid<Dim>& grid, const Vector<Dim>& x) {
  std::optional<PointPlace<Dim>> found;
  double deepest = -on_boundary;
  for (const int e : grid.own_elements()) {
    const std::array<double, Dim + 1> at = barycentric(grid.mesh, e, x);
    const double depth = std::ranges::min(at);
    if (found ? depth <= deepest : depth < deepest) continue;
    deepest = depth;
    found = PointPlace<Dim>{e, at};
  }
  return found;
}

SectionLine::SectionLine(const Grid<2>& grid, const Vector<2>& from, const Vector<2>& to) {
  std::vector<Candidate> own;
  for (const int e : grid.own_elements()) {
    const Candidate c{grid.element_number(e), barycentric(grid.mesh, e, from),
                      barycentric(grid.mesh, e, to)};
    if (c.touches()) own.push_back(c);
  }
  const std::vector<Candidate> candidates = values_on_all(grid.ranks(), own);
  const std::vector<double> shares = crossing_shares(candidates);
  const Vector<2> way = to - from;
  const Vector<2> rightward(way[1], -way[0]);    // as long as the line
  std::map<int, std::array<double, 3>> weights;  // of the sides of elements
  for (std::size_t i = 0; i + 1 < shares.size(); ++i) {
    const double part = shares[i + 1] - shares[i];
    const double middle = 0.5 * (shares[i] + shares[i + 1]);
    if (part <= 0.0) continue;
    // Use one element for each piece; a line along faces has two.
    const auto best = std::ranges::max_element(candidates, {},
                                               [&](const Candidate& c) { return c.depth(middle); });
    if (best == candidates.end() || !best->holds(middle, part)) continue;
    length_ += part * way.norm();
    const int e = grid.element_here(best->element);
    if (e < 0 || !grid.element_rows().owns(e)) continue;
    const Vector<2> x = from + middle * way;
    for (int k = 0; k < 3; ++k) {
      const Vector<2> arm = x - grid.mesh.nodes[grid.mesh.elements[e][k]];
      weights[e][k] +=
          grid.element_face_sign[e][k] * part * arm.dot(rightward) / (2.0 * grid.volume[e]);
    }
  }
  for (const auto& [e, of_sides] : weights) {
    for (int k = 0; k < 3; ++k) weights_.push_back({grid.element_face[e][k], of_sides[k]});
  }
}

ExactSum SectionLine::across(const std::vector<double>& face_values) const {
  ExactSum sum;
  for (const auto& [face, weight] : weights_) sum.add(weight * face_values[face]);
  return sum;
}

template std::optional<PointPlace<2>> find_place(const Grid<2>&, const Vector<2>&);
template std::optional<PointPlace<3>> find_place(const Grid<3>&, const Vector<3>&);

}  // namespace suffuse

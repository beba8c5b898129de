#include "checks/vertical_lines.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "checks/face_vector.hpp"
#include "mesh/faces.hpp"
#include "values/derived_fields.hpp"

namespace suffuse {
namespace {

/// Cosine of the angle between a face's normal and the vertical from which it is ground, not a
/// wall: 60 degrees.
constexpr double steepest_ground = 0.5;

/// How far a line stands off the middle of its face, as a share of the face: lines through nodes
/// and along edges have no clear way from element to element.
constexpr double off_middle = 1e-5;

template <int Dim>
std::map<std::array<int, Dim>, std::string> boundary_of_face(const Mesh<Dim>& mesh,
                                                             const Scene& scene) {
  std::map<std::array<int, Dim>, std::string> names;
  for (const BoundaryCondition& condition : scene.boundaries) {
    const auto set = std::ranges::find(mesh.boundaries, condition.on, &BoundarySet<Dim>::name);
    if (set == mesh.boundaries.end()) continue;
    for (const auto& face : set->faces) names.emplace(face_key<Dim>(face), condition.on);
  }
  return names;
}

}  // namespace

template <int Dim>
VerticalLines<Dim>::VerticalLines(const Mesh<Dim>& mesh, const Scene& scene)
    : mesh_(mesh), scene_(scene), up_(upward<Dim>(scene)) {
  find_neighbours();
  find_ground();
}

template <int Dim>
bool VerticalLines<Dim>::is_soil(int element) const {
  return scene_.find_soil(region_of(element)) != nullptr;
}

template <int Dim>
void VerticalLines<Dim>::find_neighbours() {
  neighbours_.resize(mesh_.elements.size());
  std::map<std::array<int, Dim>, std::pair<int, int>> first_owner;
  for (int e = 0; e < mesh_.element_count(); ++e) {
    neighbours_[e].fill(-1);
    for (int a = 0; a <= Dim; ++a) {
      const auto key = face_key<Dim>(face_opposite<Dim>(mesh_.elements[e], a));
      const auto [owner, is_new] = first_owner.try_emplace(key, e, a);
      if (is_new) continue;
      const auto& [other, corner] = owner->second;
      neighbours_[e][a] = other;
      neighbours_[other][corner] = e;
    }
  }
}

template <int Dim>
void VerticalLines<Dim>::find_ground() {
  const auto names = boundary_of_face<Dim>(mesh_, scene_);
  for (int e = 0; e < mesh_.element_count(); ++e) {
    if (!is_soil(e)) continue;
    for (int a = 0; a <= Dim; ++a) {
      const int other = neighbour(e, a);
      if (other >= 0 && is_soil(other)) continue;
      const Vector<Dim> normal = face_vector<Dim>(mesh_, e, a);
      if (normal.dot(up_) < steepest_ground * normal.norm()) continue;
      const auto face = face_opposite<Dim>(mesh_.elements[e], a);
      Vector<Dim> middle = Vector<Dim>::Zero();
      for (const int node : face) middle += mesh_.nodes[node] / Dim;
      middle += off_middle * (mesh_.nodes[face[0]] - middle);
      const auto name = names.find(face_key<Dim>(face));
      ground_.push_back({e, middle, barycentric<Dim>(mesh_, e, middle), normal,
                         name == names.end() ? "" : name->second});
    }
  }
}

template <int Dim>
std::optional<GroundPlace<Dim>> VerticalLines<Dim>::ground_at(double x) const {
  for (const GroundPlace<Dim>& place : ground_) {
    // The middle of an edge lies halfway between its ends, which are as far off along x as the
    // level part of the normal says.
    const Vector<Dim> along = Vector<Dim>::Unit(0) - up_[0] * up_;
    const double half = 0.5 * std::abs(place.outward.dot(up_)) / along.norm();
    const double offset = x - place.position[0];
    if (std::abs(offset) > half) continue;
    GroundPlace<Dim> moved = place;
    // Stays off the ends of the edge.
    const double shift = std::clamp(offset, -half * (1.0 - off_middle), half * (1.0 - off_middle));
    const double rise = -place.outward.dot(along) / place.outward.dot(up_);
    moved.position += shift * (Vector<Dim>::Unit(0) + rise * up_);
    moved.weights = barycentric<Dim>(mesh_, place.element, moved.position);
    return moved;
  }
  return std::nullopt;
}

template <int Dim>
std::vector<LineSegment<Dim>> VerticalLines<Dim>::below(const GroundPlace<Dim>& place) const {
  std::vector<LineSegment<Dim>> line;
  int element = place.element;
  int entry = -1;  // the element above
  Vector<Dim> x = place.position;
  while (element >= 0 && is_soil(element) &&
         line.size() < static_cast<std::size_t>(mesh_.element_count())) {
    const auto weights = barycentric<Dim>(mesh_, element, x);
    const auto beneath = barycentric<Dim>(mesh_, element, x - up_);
    int exit = -1;
    double length = std::numeric_limits<double>::infinity();
    for (int a = 0; a <= Dim; ++a) {
      if (entry >= 0 && neighbour(element, a) == entry) continue;
      const double slope = beneath[a] - weights[a];
      if (slope >= 0.0) continue;
      const double reach = std::max(0.0, -weights[a] / slope);
      if (reach >= length) continue;
      length = reach;
      exit = a;
    }
    if (exit < 0) break;
    x -= length * up_;
    line.push_back({element, length, barycentric<Dim>(mesh_, element, x)});
    entry = element;
    element = neighbour(element, exit);
  }
  return line;
}

template <int Dim>
double VerticalLines<Dim>::length_in(const std::vector<LineSegment<Dim>>& line,
                                     const std::string& region) const {
  double length = 0.0;
  for (const LineSegment<Dim>& segment : line) {
    if (region_of(segment.element) == region) length += segment.length;
  }
  return length;
}

template class VerticalLines<2>;
template class VerticalLines<3>;

}  // namespace suffuse

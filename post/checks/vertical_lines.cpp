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

/// The conditions of the outer faces.
template <int Dim>
std::map<std::array<int, Dim>, const BoundaryCondition*> condition_of_face(const Mesh<Dim>& mesh,
                                                                           const Scene& scene) {
  std::map<std::array<int, Dim>, const BoundaryCondition*> conditions;
  for (const BoundaryCondition& condition : scene.boundaries) {
    const auto set = std::ranges::find(mesh.boundaries, condition.on, &BoundarySet<Dim>::name);
    if (set == mesh.boundaries.end()) continue;
    for (const auto& face : set->faces) conditions.emplace(face_key<Dim>(face), &condition);
  }
  return conditions;
}

bool bears_water(const BoundaryCondition& condition) {
  return condition.head.has_value() || condition.pressure.has_value();
}

}  // namespace

bool lets_water_out(const BoundaryCondition& condition) {
  return bears_water(condition) || condition.seepage_face || condition.rain.has_value() ||
         condition.darcy_flux.has_value() || condition.velocity.has_value() ||
         condition.rate.has_value();
}

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
  const auto join = [&](const std::pair<int, int>& one, const std::pair<int, int>& other) {
    neighbours_[one.first][one.second] = other.first;
    neighbours_[other.first][other.second] = one.first;
  };
  for (int e = 0; e < mesh_.element_count(); ++e) {
    neighbours_[e].fill(-1);
    for (int a = 0; a <= Dim; ++a) {
      const auto key = face_key<Dim>(face_opposite<Dim>(mesh_.elements[e], a));
      const auto [owner, is_new] = first_owner.try_emplace(key, e, a);
      if (!is_new) join(owner->second, {e, a});
    }
  }
  for (const std::string& name : scene_.names_of_slits()) {
    const auto set = std::ranges::find(mesh_.boundaries, name, &BoundarySet<Dim>::name);
    if (set == mesh_.boundaries.end()) continue;
    for (std::size_t i = 0; i + 1 < set->faces.size(); i += 2) {
      const auto one = first_owner.find(face_key<Dim>(set->faces[i]));
      const auto other = first_owner.find(face_key<Dim>(set->faces[i + 1]));
      if (one != first_owner.end() && other != first_owner.end()) join(one->second, other->second);
    }
  }
}

template <int Dim>
void VerticalLines<Dim>::find_ground() {
  const auto conditions = condition_of_face<Dim>(mesh_, scene_);
  for (int e = 0; e < mesh_.element_count(); ++e) {
    if (!is_soil(e)) continue;
    for (int a = 0; a <= Dim; ++a) {
      const int other = neighbour(e, a);
      if (other >= 0 && is_soil(other)) continue;
      const auto found = conditions.find(face_key<Dim>(face_opposite<Dim>(mesh_.elements[e], a)));
      add_ground(e, a, found == conditions.end() ? nullptr : found->second);
    }
  }
}

template <int Dim>
void VerticalLines<Dim>::add_ground(int element, int corner, const BoundaryCondition* condition) {
  const Vector<Dim> normal = face_vector<Dim>(mesh_, element, corner);
  if (normal.dot(up_) < steepest_ground * normal.norm()) return;
  const auto face = face_opposite<Dim>(mesh_.elements[element], corner);
  GroundPlace<Dim> place{
      .element = element, .position = Vector<Dim>::Zero(), .weights = {}, .outward = normal};
  for (const int node : face) place.position += mesh_.nodes[node] / Dim;
  place.position += off_middle * (mesh_.nodes[face[0]] - place.position);
  place.weights = barycentric<Dim>(mesh_, element, place.position);
  if (condition != nullptr) {
    place.boundary = condition->on;
    place.bears_water = bears_water(*condition);
    place.lets_water_out = lets_water_out(*condition);
  } else if (neighbour(element, corner) >= 0) {  // free water
    place.bears_water = place.lets_water_out = true;
  }
  ground_.push_back(place);
}

template <int Dim>
std::optional<GroundPlace<Dim>> VerticalLines<Dim>::ground_at(double x, double side) const {
  std::optional<GroundPlace<Dim>> highest;
  for (const GroundPlace<Dim>& place : ground_) {
    // The middle of an edge lies halfway between its ends, which are as far off along x as the
    // level part of the normal says.
    const Vector<Dim> along = Vector<Dim>::Unit(0) - up_[0] * up_;
    const double half = 0.5 * std::abs(place.outward.dot(up_)) / along.norm();
    const double offset = x - place.position[0];
    // The place itself is off the middle by one share.
    const double slack = 2.0 * off_middle * half;
    const double before_end = half - slack;
    if (std::abs(offset) > half + slack || side * offset > before_end) continue;
    GroundPlace<Dim> moved = place;
    // Stays off the ends of the edge.
    const double shift = std::clamp(offset, -before_end, before_end);
    const double rise = -place.outward.dot(along) / place.outward.dot(up_);
    moved.position += shift * (Vector<Dim>::Unit(0) + rise * up_);
    moved.weights = barycentric<Dim>(mesh_, place.element, moved.position);
    if (!highest || moved.position.dot(up_) > highest->position.dot(up_)) highest = moved;
  }
  return highest;
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
    line.push_back({element, length, weights, barycentric<Dim>(mesh_, element, x)});
    entry = element;
    element = neighbour(element, exit);
  }
  return line;
}

template <int Dim>
LinePart<Dim> VerticalLines<Dim>::highest_layer(LinePart<Dim> line,
                                                const std::string& region) const {
  const auto is_in = [&](const LineSegment<Dim>& segment) {
    return region_of(segment.element) == region;
  };
  const auto first = std::find_if(line.begin(), line.end(), is_in);
  return {first, std::find_if_not(first, line.end(), is_in)};
}

template <int Dim>
LinePart<Dim> VerticalLines<Dim>::lowest_layer(LinePart<Dim> line,
                                               const std::string& region) const {
  LinePart<Dim> lowest = highest_layer(line, region);
  LinePart<Dim> next = lowest;
  while (!next.empty()) {
    lowest = next;
    next = highest_layer({lowest.end(), line.end()}, region);
  }
  return lowest;
}

template <int Dim>
double length_of(LinePart<Dim> part) {
  double length = 0.0;
  for (const LineSegment<Dim>& segment : part) length += segment.length;
  return length;
}

template double length_of<2>(LinePart<2>);
template double length_of<3>(LinePart<3>);

template class VerticalLines<2>;
template class VerticalLines<3>;

}  // namespace suffuse

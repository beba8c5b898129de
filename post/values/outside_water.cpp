#include "values/outside_water.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "mesh/faces.hpp"

namespace suffuse {
namespace {

/// Largest lean of an upright edge, relative to its length. There the model is cut off, mostly, and
/// no free water stands.
constexpr double upright = 0.05;

/// Directions against gravity and across it.
struct Axes {
  Vector<2> up;
  Vector<2> across;
};

/// The vertex opposite to each outer edge tells its outer side.
std::map<std::array<int, 2>, int> opposite_nodes(const Mesh<2>& mesh) {
  std::map<std::array<int, 2>, int> opposite;
  for (const auto& nodes : mesh.elements) {
    for (int a = 0; a < 3; ++a) {
      opposite[face_key<2>(face_opposite<2>(nodes, a))] = nodes[a];
    }
  }
  return opposite;
}

/// The ends of the part of an edge that is below the level; nothing if no part is.
std::optional<std::array<Vector<2>, 2>> wet_part(const Vector<2>& a, const Vector<2>& b,
                                                 const Vector<2>& up, double head) {
  const double za = a.dot(up);
  const double zb = b.dot(up);
  if (za >= head && zb >= head) return std::nullopt;
  std::array<Vector<2>, 2> part{a, b};
  if (za > head) part[0] = a + (za - head) / (za - zb) * (b - a);
  if (zb > head) part[1] = b + (zb - head) / (zb - za) * (a - b);
  return part;
}

/// The water over one wet edge; nothing beside an upright one and below an overhang.
std::optional<std::array<Vector<2>, 4>> water_over(const std::array<Vector<2>, 2>& wet,
                                                   const Vector<2>& inside, const Axes& axes,
                                                   double head) {
  const auto& [a, b] = wet;
  const Vector<2> way = b - a;
  const double rise = std::abs(way.dot(axes.up));
  const double run = std::abs(way.dot(axes.across));
  if (run <= upright * rise) return std::nullopt;
  // Where the soil is above the edge, the edge is an overhang, and no water is over it.
  const double slope = way.dot(axes.up) / way.dot(axes.across);
  const Vector<2> arm = inside - a;
  if (arm.dot(axes.up) >= slope * arm.dot(axes.across)) return std::nullopt;
  return std::array<Vector<2>, 4>{a, b, b + (head - b.dot(axes.up)) * axes.up,
                                  a + (head - a.dot(axes.up)) * axes.up};
}

}  // namespace

bool has_level(const Scene& scene, const std::string& boundary) {
  return std::ranges::any_of(scene.boundaries, [&](const BoundaryCondition& condition) {
    return condition.on == boundary && condition.head;
  });
}

std::vector<OutsideWater> outside_water(const Mesh<2>& mesh, const Scene& scene, double time,
                                        double breadth) {
  const Vector<2> gravity(scene.gravity[0], scene.gravity[1]);
  std::vector<OutsideWater> waters;
  if (gravity.norm() == 0.0) return waters;
  const Vector<2> up = -gravity.normalized();
  const Axes axes{up, Vector<2>(up[1], -up[0])};
  const auto opposite = opposite_nodes(mesh);
  double middle = 0.0;  // middle of the model across gravity, m
  for (const Vector<2>& x : mesh.nodes) {
    middle += x.dot(axes.across) / static_cast<double>(mesh.nodes.size());
  }
  for (const BoundaryCondition& boundary : scene.boundaries) {
    if (!boundary.head || boundary.is_well()) continue;
    const auto set = std::ranges::find(mesh.boundaries, boundary.on, &BoundarySet<2>::name);
    if (set == mesh.boundaries.end()) continue;
    OutsideWater water{boundary.on, boundary.head->value(time), {}, {}};
    for (const auto& face : set->faces) {
      const auto wet = wet_part(mesh.nodes[face[0]], mesh.nodes[face[1]], up, water.head);
      if (!wet) continue;
      const Vector<2>& inside = mesh.nodes[opposite.at(face_key<2>(face))];
      if (const auto body = water_over(*wet, inside, axes, water.head)) {
        water.body.push_back(*body);
      }
    }
    if (water.body.empty()) continue;
    double begin = std::numeric_limits<double>::infinity();
    double end = -begin;
    for (const auto& corners : water.body) {
      for (const Vector<2>& corner : corners) {
        begin = std::min(begin, corner.dot(axes.across));
        end = std::max(end, corner.dot(axes.across));
      }
    }
    // Room for the sign of a level, where the water outside ends.
    if (end - begin < breadth) {
      const bool to_the_right = begin + end > 2.0 * middle;
      (to_the_right ? end : begin) = to_the_right ? begin + breadth : end - breadth;
    }
    water.level = {water.head * up + begin * axes.across, water.head * up + end * axes.across};
    waters.push_back(std::move(water));
  }
  return waters;
}

}  // namespace suffuse

#include "curve_crossings.hpp"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/short_number.hpp"
#include "gmsh_session.hpp"
#include "gmsh_types.hpp"
#include "mesh/mesh.hpp"

namespace suffuse {

namespace {

using Tag = std::size_t;

/// Relative to the length of an edge.
constexpr double same_place = 1e-9;
constexpr std::size_t max_examples = 3;

/// An edge of the mesh of a curve.
struct Edge {
  int curve = 0;
  std::array<Tag, 2> nodes{};
  std::array<Vector<2>, 2> ends;

  [[nodiscard]] double low(int axis) const { return std::min(ends[0][axis], ends[1][axis]); }
  [[nodiscard]] double high(int axis) const { return std::max(ends[0][axis], ends[1][axis]); }
};

double cross(const Vector<2>& a, const Vector<2>& b) {
  return a[0] * b[1] - a[1] * b[0];
}

std::vector<Edge> edges_of_curves() {
  std::vector<Tag> tags;
  std::vector<double> x;
  std::vector<double> parameters;
  gmsh::model::mesh::getNodes(tags, x, parameters);
  std::map<Tag, Vector<2>> places;
  for (std::size_t i = 0; i < tags.size(); ++i) places[tags[i]] = {x[3 * i], x[3 * i + 1]};
  gmsh::vectorpair curves;
  gmsh::model::getEntities(curves, 1);
  std::vector<Edge> edges;
  for (const auto& [dimension, curve] : curves) {
    std::vector<Tag> ignored;
    std::vector<Tag> nodes;
    gmsh::model::mesh::getElementsByType(gmsh_type::line, ignored, nodes, curve);
    for (std::size_t i = 0; i + 1 < nodes.size(); i += 2) {
      edges.push_back(
          {curve, {nodes[i], nodes[i + 1]}, {places.at(nodes[i]), places.at(nodes[i + 1])}});
    }
  }
  return edges;
}

/// The place at which two edges without a common node meet.
std::optional<Vector<2>> meeting_place(const Edge& a, const Edge& b) {
  for (const Tag node : a.nodes) {
    if (node == b.nodes[0] || node == b.nodes[1]) return std::nullopt;
  }
  const Vector<2> along_a = a.ends[1] - a.ends[0];
  const Vector<2> along_b = b.ends[1] - b.ends[0];
  const Vector<2> between = b.ends[0] - a.ends[0];
  const double lengths = along_a.norm() * along_b.norm();
  const double sine = cross(along_a, along_b);
  const auto lies_within = [](double share) {
    return share >= -same_place && share <= 1.0 + same_place;
  };
  if (std::abs(sine) > same_place * lengths) {
    const double share_a = cross(between, along_b) / sine;
    const double share_b = cross(between, along_a) / sine;
    if (!lies_within(share_a) || !lies_within(share_b)) return std::nullopt;
    return a.ends[0] + share_a * along_a;
  }
  // Parallel: they meet where one lies on the other.
  if (std::abs(cross(between, along_a)) > same_place * lengths) return std::nullopt;
  for (const Vector<2>& end : b.ends) {
    if (lies_within((end - a.ends[0]).dot(along_a) / along_a.squaredNorm())) return end;
  }
  return std::nullopt;
}

std::string text_of(const Edge& a, const Edge& b, const Vector<2>& at) {
  const auto [first, second] = std::minmax(a.curve, b.curve);
  const std::string where = " at (" + short_number(at[0]) + ", " + short_number(at[1]) + ")";
  if (first == second) return "curve " + std::to_string(first) + " that meets itself" + where;
  return "curves " + std::to_string(first) + " and " + std::to_string(second) + " that meet" +
         where;
}

}  // namespace

std::vector<std::string> curve_crossings() {
  std::vector<Edge> edges = edges_of_curves();
  if (edges.empty()) {
    gmsh_complaint([] { gmsh::model::mesh::generate(1); });
    edges = edges_of_curves();
  }
  std::ranges::sort(edges, {}, [](const Edge& edge) { return edge.low(0); });
  std::vector<std::string> found;
  std::set<std::pair<int, int>> reported;  // curves
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = i + 1; j < edges.size() && edges[j].low(0) <= edges[i].high(0); ++j) {
      if (edges[j].low(1) > edges[i].high(1) || edges[i].low(1) > edges[j].high(1)) continue;
      const auto place = meeting_place(edges[i], edges[j]);
      if (!place) continue;
      if (!reported.insert(std::minmax(edges[i].curve, edges[j].curve)).second) continue;
      found.push_back(text_of(edges[i], edges[j], *place));
      if (found.size() == max_examples) return found;
    }
  }
  return found;
}

}  // namespace suffuse

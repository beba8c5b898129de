#include "drawing/contours.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace suffuse {
namespace {

/// An edge of the mesh that a contour crosses, by its nodes in ascending order.
using Edge = std::pair<int, int>;

/// Where a contour crosses the mesh: edges, each with the one or two that come next on the line.
using Crossings = std::map<Edge, std::vector<Edge>>;

Crossings crossings_of(const Mesh<2>& mesh, const std::vector<double>& at_nodes, double level) {
  Crossings crossings;
  const auto is_finite = [&](int node) { return std::isfinite(at_nodes[node]); };
  for (const auto& nodes : mesh.elements) {
    if (!std::ranges::all_of(nodes, is_finite)) continue;
    std::vector<Edge> crossed;
    for (int a = 0; a < 3; ++a) {
      const auto [i, j] = std::minmax(nodes[a], nodes[(a + 1) % 3]);
      if ((at_nodes[i] >= level) != (at_nodes[j] >= level)) crossed.emplace_back(i, j);
    }
    if (crossed.size() != 2) continue;
    crossings[crossed[0]].push_back(crossed[1]);
    crossings[crossed[1]].push_back(crossed[0]);
  }
  return crossings;
}

/// Removes the line that starts with `edge` from the crossings and returns it.
std::vector<Edge> take_line(Crossings& crossings, Edge edge) {
  std::vector<Edge> line{edge};
  for (;;) {
    auto& next = crossings[edge];
    if (next.empty()) return line;
    const Edge to = next.back();
    next.pop_back();
    std::erase(crossings[to], edge);
    line.push_back(to);
    edge = to;
  }
}

/// Cuts off the part of a convex polygon where the values, times `sign`, are below `level`.
void clip(Polyline& polygon, std::vector<double>& values, double level, double sign) {
  Polyline kept;
  std::vector<double> kept_values;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = (i + 1) % polygon.size();
    const double a = sign * (values[i] - level);
    const double b = sign * (values[j] - level);
    if (a >= 0.0) {
      kept.push_back(polygon[i]);
      kept_values.push_back(values[i]);
    }
    if ((a >= 0.0) != (b >= 0.0)) {
      kept.emplace_back(polygon[i] + a / (a - b) * (polygon[j] - polygon[i]));
      kept_values.push_back(level);
    }
  }
  polygon = std::move(kept);
  values = std::move(kept_values);
}

}  // namespace

std::vector<Polyline> contour_lines(const Mesh<2>& mesh, const std::vector<double>& at_nodes,
                                    double level) {
  Crossings crossings = crossings_of(mesh, at_nodes, level);
  std::vector<Edge> starts;
  for (const auto& [edge, next] : crossings) {
    if (next.size() == 1) starts.push_back(edge);
  }
  // Closed lines follow; they may start anywhere.
  for (const auto& [edge, next] : crossings) starts.push_back(edge);
  std::vector<Polyline> lines;
  for (const Edge& start : starts) {
    if (crossings[start].empty()) continue;
    Polyline line;
    for (const auto& [i, j] : take_line(crossings, start)) {
      const double share = (level - at_nodes[i]) / (at_nodes[j] - at_nodes[i]);
      line.emplace_back(mesh.nodes[i] + share * (mesh.nodes[j] - mesh.nodes[i]));
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

Polyline band_in_triangle(const std::array<Vector<2>, 3>& corners,
                          const std::array<double, 3>& values, double low, double high) {
  Polyline polygon(corners.begin(), corners.end());
  std::vector<double> at(values.begin(), values.end());
  clip(polygon, at, low, 1.0);
  clip(polygon, at, high, -1.0);
  return polygon.size() < 3 ? Polyline{} : polygon;
}

double length(const Polyline& line) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) sum += (line[i + 1] - line[i]).norm();
  return sum;
}

Vector<2> place_on(const Polyline& line, double share) {
  double left = share * length(line);
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double piece = (line[i + 1] - line[i]).norm();
    if (piece >= left && piece > 0.0) return line[i] + left / piece * (line[i + 1] - line[i]);
    left -= piece;
  }
  return line.back();
}

}  // namespace suffuse

#include "values/sheet.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "mesh/faces.hpp"

namespace suffuse {
namespace {

/// Nodes this close to a plane lie in it, relative to the extent of the mesh.
constexpr double in_plane = 1e-9;
constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

/// Where a field has a value, along edges of a mesh. A node with that value is above it.
class Crossings {
 public:
  Crossings(const std::vector<double>& at_nodes, double level, std::vector<EdgePlace>& nodes)
      : at_nodes_(at_nodes), level_(level), nodes_(nodes) {}

  [[nodiscard]] bool is_above(int node) const { return at_nodes_[node] >= level_; }
  /// The node of the sheet on the edge between a node above and one below.
  int node(int above, int below) {
    const double share = (at_nodes_[above] - level_) / (at_nodes_[above] - at_nodes_[below]);
    const std::array<int, 2> key{above, share > 0.0 ? below : above};
    const auto [found, is_new] = numbers_.emplace(key, static_cast<int>(nodes_.size()));
    if (is_new) nodes_.push_back({key, share});
    return found->second;
  }

 private:
  const std::vector<double>& at_nodes_;
  double level_;
  std::vector<EdgePlace>& nodes_;
  std::map<std::array<int, 2>, int> numbers_;
};

/// The corners of an element above the level and below.
struct Sides {
  std::vector<int> above;
  std::vector<int> below;
};

template <class Nodes>
Sides sides_of(const Crossings& crossings, const Nodes& nodes) {
  Sides sides;
  for (const int node : nodes)
    (crossings.is_above(node) ? sides.above : sides.below).push_back(node);
  return sides;
}

/// The part of the level in a tetrahedron: its corners in order, each once.
std::vector<int> polygon_in(Crossings& crossings, const Sides& sides) {
  std::vector<int> corners;
  for (const int a : sides.above) {
    const auto add = [&](int b) { corners.push_back(crossings.node(a, b)); };
    // The second corner above goes the other way round, so that the four do not cross.
    const bool back = sides.above.size() == 2 && a == sides.above[1];
    if (back) {
      std::for_each(sides.below.rbegin(), sides.below.rend(), add);
    } else {
      std::ranges::for_each(sides.below, add);
    }
  }
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  return corners;
}

/// A sheet of a level, and the ends of its lines on the boundaries of a mesh.
struct LevelSheet {
  Sheet sheet;
  std::vector<BoundarySet<2>> boundaries;
};

LevelSheet make_level_sheet(const Mesh<3>& mesh, const std::vector<double>& at_nodes,
                            double level) {
  LevelSheet made;
  Sheet& sheet = made.sheet;
  Crossings crossings(at_nodes, level, sheet.nodes);
  const auto is_finite = [&](int node) { return std::isfinite(at_nodes[node]); };
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!std::ranges::all_of(mesh.elements[e], is_finite)) continue;
    const Sides sides = sides_of(crossings, mesh.elements[e]);
    if (sides.above.empty() || sides.below.empty()) continue;
    const std::vector<int> corners = polygon_in(crossings, sides);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      sheet.triangles.push_back({corners[0], corners[i], corners[i + 1]});
      sheet.element.push_back(e);
    }
  }
  for (const BoundarySet<3>& boundary : mesh.boundaries) {
    BoundarySet<2> lines{boundary.name, {}};
    for (const auto& face : boundary.faces) {
      if (!std::ranges::all_of(face, is_finite)) continue;
      const Sides sides = sides_of(crossings, face);
      if (sides.above.empty() || sides.below.empty()) continue;
      const std::vector<int> ends = polygon_in(crossings, sides);
      if (ends.size() == 2) lines.faces.push_back({ends[0], ends[1]});
    }
    if (!lines.faces.empty()) made.boundaries.push_back(std::move(lines));
  }
  return made;
}

/// Distances of nodes from the plane, times `sign`; exactly 0 in the plane.
std::vector<double> distances(const Mesh<3>& mesh, const CutPlane& plane, double sign) {
  const double slack = in_plane * extent(mesh).maxCoeff();
  std::vector<double> values;
  for (const Vector<3>& x : mesh.nodes) {
    const double distance = x[plane.axis] - plane.at;
    values.push_back(std::abs(distance) < slack ? 0.0 : sign * distance);
  }
  return values;
}

/// Removes boundary faces that are not sides of an element: elements that the plane touches only
/// along an edge have no triangles.
void keep_sides(Mesh<2>& mesh) {
  const FaceTable<2> sides(mesh);
  for (BoundarySet<2>& boundary : mesh.boundaries) {
    std::erase_if(boundary.faces, [&](const auto& face) { return sides.owners(face) == 0; });
  }
}

InputError beside_model(const Mesh<3>& mesh, const CutPlane& plane, const std::string& command) {
  const auto less = [&](const Vector<3>& a, const Vector<3>& b) {
    return a[plane.axis] < b[plane.axis];
  };
  const auto [low, high] = std::ranges::minmax_element(mesh.nodes, less);
  return InputError(InputProblem{
      command, "--cut", cut_text(plane),
      "a plane through the model, " + std::string(axis_names.at(plane.axis)) + " from " +
          number_text((*low)[plane.axis]) + " to " + number_text((*high)[plane.axis]) + " m"});
}

}  // namespace

Vector<3> position(const Mesh<3>& mesh, const EdgePlace& place) {
  const Vector<3>& from = mesh.nodes[place.nodes[0]];
  return from + place.share * (mesh.nodes[place.nodes[1]] - from);
}

Sheet outer_sheet(const Mesh<3>& mesh) {
  const FaceTable<3> owners(mesh);
  Sheet sheet;
  std::map<int, int> numbers;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int corner = 0; corner < 4; ++corner) {
      auto face = face_opposite<3>(mesh.elements[e], corner);
      if (owners.owners(face) != 1) continue;
      const Vector<3>& a = mesh.nodes[face[0]];
      const Vector<3> normal = (mesh.nodes[face[1]] - a).cross(mesh.nodes[face[2]] - a);
      if (normal.dot(mesh.nodes[mesh.elements[e][corner]] - a) > 0.0) std::swap(face[1], face[2]);
      for (int& node : face) {
        const auto [found, is_new] = numbers.emplace(node, static_cast<int>(sheet.nodes.size()));
        if (is_new) sheet.nodes.push_back({{node, node}, 0.0});
        node = found->second;
      }
      sheet.triangles.push_back(face);
      sheet.element.push_back(e);
    }
  }
  return sheet;
}

Sheet level_sheet(const Mesh<3>& mesh, const std::vector<double>& at_nodes, double level) {
  return make_level_sheet(mesh, at_nodes, level).sheet;
}

std::vector<double> sheet_values(const Mesh<3>& mesh, const Sheet& sheet, const std::string& where,
                                 const std::vector<double>& values) {
  std::vector<double> result;
  const auto mixed = [](double from, double to, double share) {
    return from == to ? from : from + share * (to - from);
  };
  if (where == "cell") {
    for (const int e : sheet.element) result.push_back(values[e]);
  } else if (where == "node") {
    for (const EdgePlace& place : sheet.nodes) {
      result.push_back(mixed(values[place.nodes[0]], values[place.nodes[1]], place.share));
    }
  } else {
    for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
      const auto& nodes = mesh.elements[sheet.element[t]];
      const auto value = [&](int node) {
        const auto corner = std::ranges::find(nodes, node) - nodes.begin();
        return values[4 * static_cast<std::size_t>(sheet.element[t]) + corner];
      };
      for (const int i : sheet.triangles[t]) {
        const EdgePlace& place = sheet.nodes[i];
        result.push_back(mixed(value(place.nodes[0]), value(place.nodes[1]), place.share));
      }
    }
  }
  return result;
}

std::vector<double> node_means(const Mesh<3>& mesh, const std::string& where,
                               const std::vector<double>& values) {
  if (where == "node") return values;
  std::vector<double> sums(mesh.nodes.size(), 0.0);
  std::vector<double> volumes(mesh.nodes.size(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double volume = element_volume(mesh, e);
    for (int a = 0; a < 4; ++a) {
      const int node = mesh.elements[e][a];
      sums[node] += volume * values[where == "cell" ? e : 4 * e + a];
      volumes[node] += volume;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= volumes[i];
  return sums;
}

CutPlane parse_cut(const std::string& text, const std::string& command) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!text.starts_with(std::string(axis_names.at(axis)) + "=")) continue;
    const auto at = parse_number(text.substr(2));
    if (at && std::isfinite(*at)) return {axis, *at};
  }
  throw InputError(std::vector{
      InputProblem{command, "--cut", '"' + text + '"', "x=, y= or z= and a number in metres", ""}});
}

std::string cut_text(const CutPlane& plane) {
  return std::string(axis_names.at(plane.axis)) + " = " + number_text(plane.at) + " m";
}

PlaneCut plane_cut(const Mesh<3>& mesh, const CutPlane& plane, const std::string& command) {
  // Nodes in the plane count as above it: at the lower end of the model nothing is below.
  LevelSheet made = make_level_sheet(mesh, distances(mesh, plane, 1.0), 0.0);
  if (made.sheet.triangles.empty()) {
    made = make_level_sheet(mesh, distances(mesh, plane, -1.0), 0.0);
  }
  if (made.sheet.triangles.empty()) throw beside_model(mesh, plane, command);
  PlaneCut cut;
  cut.axes = {plane.axis == 0 ? 1 : 0, plane.axis == 2 ? 1 : 2};
  for (const EdgePlace& place : made.sheet.nodes) {
    const Vector<3> x = position(mesh, place);
    cut.mesh.nodes.emplace_back(x[cut.axes[0]], x[cut.axes[1]]);
  }
  cut.mesh.region_names = mesh.region_names;
  for (std::size_t t = 0; t < made.sheet.triangles.size(); ++t) {
    cut.mesh.elements.push_back(made.sheet.triangles[t]);
    const bool turns_right = element_volume(cut.mesh, static_cast<int>(t)) < 0.0;
    auto& triangle = made.sheet.triangles[t];
    if (turns_right) std::swap(triangle[1], triangle[2]);
    cut.mesh.elements.back() = triangle;
    cut.mesh.element_region.push_back(mesh.element_region[made.sheet.element[t]]);
  }
  cut.mesh.boundaries = std::move(made.boundaries);
  keep_sides(cut.mesh);
  cut.sheet = std::move(made.sheet);
  return cut;
}

}  // namespace suffuse

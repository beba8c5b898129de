#include "inner_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "mesh/faces.hpp"
#include "mesh/slit.hpp"
#include "mesh_problems.hpp"

namespace suffuse {

namespace {

template <int Dim>
class InnerCuts {
 public:
  using Face = std::array<int, Dim>;

  InnerCuts(const SceneDocument& document, ExtractedMesh<Dim>& extracted)
      : document_(document), extracted_(extracted) {}

  InnerNames run(std::vector<std::string>& notes) {
    const Scene& scene = document_.scene;
    const std::string word = MeshWords<Dim>::boundary;
    for (std::size_t i = 0; i < scene.walls.size(); ++i) {
      const std::string key = "wall[" + std::to_string(i) + "].on";
      const std::string& name = scene.walls[i].on;
      if (cut_curve(key, name) || !find_point(name)) continue;
      report(key, '"' + name + "\", a point", "a " + word + " inside the mesh");
    }
    std::vector<const BoundaryCondition*> at_points;
    for (const BoundaryCondition& boundary : scene.boundaries) {
      if (!boundary.is_well()) continue;
      if (!cut_curve(boundary.key + ".on", boundary.on)) at_points.push_back(&boundary);
    }
    for (const BoundaryCondition* well : at_points) cut_point(well->key + ".on", well->on);
    open_all();
    InnerNames names;
    for (const auto& curve : extracted_.inner_curves) {
      names.curves.push_back(curve.name);
      if (key_of_.contains(curve.name) || named_by_boundary(curve.name)) continue;
      notes.push_back("the " + word + " \"" + curve.name +
                      "\" lies inside the mesh and no wall or well names it: it does nothing");
    }
    for (const NamedNode& point : extracted_.points) names.points.push_back(point.name);
    return names;
  }

 private:
  void report(const std::string& key, const std::string& found, const std::string& expected) {
    extracted_.problems.push_back({document_.locate(key), key, found, expected, ""});
  }

  [[nodiscard]] bool named_by_boundary(const std::string& name) const {
    return std::ranges::any_of(document_.scene.boundaries,
                               [&](const auto& b) { return b.on == name; });
  }

  /// Adds the curve of this name inside the mesh to the cuts; false if there is none.
  bool cut_curve(const std::string& key, const std::string& name) {
    const auto& curves = extracted_.inner_curves;
    const auto curve = std::ranges::find(curves, name, &BoundarySet<Dim>::name);
    if (curve == curves.end()) return false;
    add(key, *curve);
    return true;
  }

  [[nodiscard]] const NamedNode* find_point(const std::string& name) const {
    const auto point = std::ranges::find(extracted_.points, name, &NamedNode::name);
    return point == extracted_.points.end() ? nullptr : &*point;
  }

  void cut_point(const std::string& key, const std::string& name) {
    const NamedNode* point = find_point(name);
    if (!point) return;
    key_of_[name] = key;
    if (document_.scene.moves()) {
      const std::string boundary = MeshWords<Dim>::boundary;
      report(key, '"' + name + "\", a point, with a skeleton that moves",
             "a " + boundary + " inside the mesh, along which the soil can slide");
      return;
    }
    if constexpr (Dim == 3) {
      report(key, '"' + name + "\", a point", "a surface inside the mesh");
    } else {
      const std::optional<std::array<Face, 2>> edges = edges_in_line(point->node);
      if (edges) {
        add(key, {name, {edges->begin(), edges->end()}});
        return;
      }
      report(key,
             '"' + name + "\", a point at " + place_text<Dim>(extracted_.mesh.nodes[point->node]) +
                 " without two inner edges that no wall and no other well has",
             "a point in the soil, two elements or more off walls, wells and boundaries");
    }
  }

  /// Adds a cut; sides that belong to another cut are a problem.
  void add(const std::string& key, const BoundarySet<Dim>& set) {
    const std::string side = MeshWords<Dim>::side;
    key_of_[set.name] = key;
    for (const Face& face : set.faces) {
      const auto [entry, is_new] = cut_.emplace(face_key<Dim>(face), set.name);
      if (is_new || entry->second == set.name) continue;
      report(key,
             '"' + set.name + "\", which shares the " + side + " at " +
                 place_text<Dim>(centre(face)) + " with \"" + entry->second + '"',
             "walls and wells that share no " + side);
      return;
    }
    cuts_.push_back(set);
  }

  void open_all() {
    std::set<std::string> reported;
    for (const JoinedFace<Dim>& face : slit(extracted_.mesh, cuts_)) {
      if (!reported.insert(face.name).second) continue;
      report(key_of_.at(face.name),
             '"' + face.name + "\" with a single " + MeshWords<Dim>::side + ", at " +
                 place_text<Dim>(centre(face.nodes)) + ", between " +
                 (Dim == 2 ? "two ends" : "borders") + " in the soil",
             std::string("a ") + MeshWords<Dim>::boundary + " of at least two " +
                 MeshWords<Dim>::sides + ": a smaller mesh.size there");
    }
  }

  [[nodiscard]] Vector<Dim> centre(const Face& face) const {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (const int node : face) sum += extracted_.mesh.nodes[node];
    return sum / Dim;
  }

  /// Nodes at the other ends of the edges of an inner node that can be cut; empty for an outer
  /// node.
  [[nodiscard]] std::vector<int> neighbours(int node) const {
    std::map<int, int> elements;  // number of elements at the edge to each node
    for (const auto& corners : extracted_.mesh.elements) {
      if (!std::ranges::count(corners, node)) continue;
      for (const int other : corners) {
        if (other != node) ++elements[other];
      }
    }
    std::vector<int> result;
    for (const auto& [other, count] : elements) {
      if (count != 2) return {};
      if (!cut_.contains(face_key<Dim>({node, other}))) result.push_back(other);
    }
    return result;
  }

  /// The two edges of a node that are closest to a straight line; of several such pairs (regular
  /// mesh) that nearest to the x-axis, for any numbering of the nodes.
  [[nodiscard]] std::optional<std::array<Face, 2>> edges_in_line(int node) const {
    constexpr double round_off = 1e-9;
    const auto& x = extracted_.mesh.nodes;
    const std::vector<int> ends = neighbours(node);
    std::optional<std::array<Face, 2>> best;
    double best_bend = 0.0;
    double best_slope = 0.0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      for (std::size_t j = i + 1; j < ends.size(); ++j) {
        const Vector<Dim> a = (x[ends[i]] - x[node]).normalized();
        const Vector<Dim> b = (x[ends[j]] - x[node]).normalized();
        const double bend = (a + b).norm();
        const double slope = std::abs((a - b)[1]);
        const bool straighter = bend < best_bend - round_off;
        const bool as_straight = std::abs(bend - best_bend) <= round_off;
        if (best && !straighter && !(as_straight && slope < best_slope - round_off)) continue;
        best = {Face{node, ends[i]}, Face{node, ends[j]}};
        best_bend = bend;
        best_slope = slope;
      }
    }
    return best;
  }

  const SceneDocument& document_;
  ExtractedMesh<Dim>& extracted_;
  std::vector<BoundarySet<Dim>> cuts_;
  std::map<Face, std::string> cut_;            ///< by edge, the name of the cut
  std::map<std::string, std::string> key_of_;  ///< by name, the scene's key that names the cut
};

}  // namespace

template <int Dim>
InnerNames cut_walls_and_wells(const SceneDocument& document, ExtractedMesh<Dim>& extracted,
                               std::vector<std::string>& notes) {
  return InnerCuts<Dim>(document, extracted).run(notes);
}

template InnerNames cut_walls_and_wells(const SceneDocument&, ExtractedMesh<2>&,
                                        std::vector<std::string>&);
template InnerNames cut_walls_and_wells(const SceneDocument&, ExtractedMesh<3>&,
                                        std::vector<std::string>&);

}  // namespace suffuse

#include "mesh_extraction.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>

#include "case/closest_name.hpp"
#include "case/faces.hpp"
#include "case/short_number.hpp"
#include "gmsh_types.hpp"

namespace suffuse {

namespace {

using Tag = std::size_t;

/// Relative to the square of the longest edge; an angle of about 1e-10 degrees.
constexpr double smallest_area = 1e-12;
/// Relative to the diagonal of the mesh.
constexpr double out_of_plane = 1e-9;
constexpr double same_place = 1e-9;
/// Of a coordinate, m: areas are products of two, and their squares are still numbers.
constexpr double max_coordinate = 1e50;
/// Characters.
constexpr std::size_t longest_name = 127;
/// Of one kind, before "and N more".
constexpr std::size_t max_examples = 5;

std::string place(const Vector<2>& x) {
  return "(" + short_number(x[0]) + ", " + short_number(x[1]) + ")";
}

/// Names go into files, tables and messages: in UTF-8, and without what moves a terminal's cursor.
bool is_plain_name(const std::string& name) {
  std::size_t expected = 0;  // bytes that continue a character
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) return false;
    const bool continues = (byte & 0xc0U) == 0x80U;
    if (continues != (expected > 0)) return false;
    if (continues) {
      --expected;
    } else if (byte >= 0x80U) {
      if (byte < 0xc2U || byte > 0xf4U) return false;
      expected = byte < 0xe0U ? 1 : byte < 0xf0U ? 2 : 3;
    }
  }
  return expected == 0 && name.size() <= longest_name;
}

/// Problems of one kind: the first few one by one, the rest counted.
class Kind {
 public:
  Kind(std::vector<InputProblem>& problems, std::string expected)
      : problems_(problems), expected_(std::move(expected)) {}
  Kind(const Kind&) = delete;
  Kind& operator=(const Kind&) = delete;
  ~Kind() {
    if (count_ <= max_examples) return;
    problems_[last_].found += ", and " + std::to_string(count_ - max_examples) + " more like it";
  }
  void add(const std::string& found) {
    if (++count_ > max_examples) return;
    last_ = problems_.size();
    problems_.push_back({"", "", found, expected_, ""});
  }

 private:
  std::vector<InputProblem>& problems_;
  std::string expected_;
  std::size_t count_ = 0;
  std::size_t last_ = 0;  // index of the last one listed
};

struct Elements {
  std::vector<Tag> tags;
  std::vector<std::vector<Tag>> nodes;
};

class Extraction {
 public:
  explicit Extraction(Quadrangles quadrangles) : quadrangles_(quadrangles) {}

  ExtractedMesh run() {
    read_nodes();
    refuse_volumes();
    if (result_.problems.empty()) read_surfaces();
    if (triangle_tags_.empty()) return std::move(result_);
    number_nodes();
    if (!has_coordinates()) return std::move(result_);
    result_.comparable = true;
    check_plane();
    check_duplicate_nodes();
    orient_and_check_areas();
    check_overlaps();
    const OuterEdges outer = edges_of_one_triangle();
    check_hanging_nodes(outer);
    check_parts(outer);
    read_boundaries();
    read_points();
    return std::move(result_);
  }

 private:
  /// Edges that one triangle alone has, with it.
  using OuterEdges = std::map<std::array<int, 2>, int>;

  Mesh<2>& mesh() { return result_.mesh; }

  void report(const std::string& found, const std::string& expected) {
    result_.problems.push_back({"", "", found, expected, ""});
  }

  void read_nodes() {
    std::vector<Tag> tags;
    std::vector<double> coordinates;
    std::vector<double> parameters;
    gmsh::model::mesh::getNodes(tags, coordinates, parameters);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      coordinates_[tags[i]] = {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]};
      last_tag_ = std::max(last_tag_, tags[i]);
    }
  }

  [[nodiscard]] std::string place_of(const std::vector<Tag>& nodes) const {
    Vector<2> centre = Vector<2>::Zero();
    for (Tag node : nodes) {
      const auto& x = coordinates_.at(node);
      centre += Vector<2>(x[0], x[1]) / static_cast<double>(nodes.size());
    }
    return place(centre);
  }

  /// The elements of an entity that have the wanted type; the others are problems.
  Elements read_entity(int dimension, int entity, int wanted, Kind& wrong_types) {
    Elements result;
    std::vector<int> types;
    std::vector<std::vector<Tag>> tags;
    std::vector<std::vector<Tag>> nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
    for (std::size_t t = 0; t < types.size(); ++t) {
      if (tags[t].empty()) continue;
      const std::size_t per_element = nodes[t].size() / tags[t].size();
      for (std::size_t i = 0; i < tags[t].size(); ++i) {
        const auto first = nodes[t].begin() + static_cast<std::ptrdiff_t>(i * per_element);
        std::vector<Tag> corners(first, first + static_cast<std::ptrdiff_t>(per_element));
        if (types[t] == gmsh_type::quadrangle && wanted == gmsh_type::triangle &&
            quadrangles_ == Quadrangles::cut_along_diagonals) {
          cut(tags[t][i], corners, result);
          continue;
        }
        if (types[t] != wanted) {
          wrong_types.add("element " + std::to_string(tags[t][i]) + " (" + type_name(types[t]) +
                          ") at " + place_of(corners));
          continue;
        }
        result.tags.push_back(tags[t][i]);
        result.nodes.push_back(std::move(corners));
      }
    }
    return result;
  }

  /// Adds the four triangles of a quadrangle, with a node where its diagonals cross.
  void cut(Tag tag, const std::vector<Tag>& corners, Elements& result) {
    std::array<Vector<2>, 4> x;
    for (int a = 0; a < 4; ++a) {
      const auto& position = coordinates_.at(corners[a]);
      x[a] = {position[0], position[1]};
    }
    const Vector<2> first = x[2] - x[0];
    const Vector<2> second = x[3] - x[1];
    const Vector<2> between = x[1] - x[0];
    const double share = (between[0] * second[1] - between[1] * second[0]) /
                         (first[0] * second[1] - first[1] * second[0]);
    // Outside (0, 1) the quadrangle is not convex; its mean point then at least shows where it is.
    const bool convex = share > 0.0 && share < 1.0;
    const Vector<2> middle =
        convex ? Vector<2>(x[0] + share * first) : Vector<2>(0.25 * (x[0] + x[1] + x[2] + x[3]));
    const Tag node = ++last_tag_;
    coordinates_[node] = {middle[0], middle[1], coordinates_.at(corners[0])[2]};
    for (int a = 0; a < 4; ++a) {
      result.tags.push_back(tag);
      result.nodes.push_back({corners[a], corners[(a + 1) % 4], node});
    }
  }

  static std::string type_name(int type) {
    std::string name;
    int dimension = 0;
    int order = 0;
    int node_count = 0;
    int primary_count = 0;
    std::vector<double> coordinates;
    gmsh::model::mesh::getElementProperties(type, name, dimension, order, node_count, coordinates,
                                            primary_count);
    return name;
  }

  static bool has_elements(int dimension, int entity) {
    std::vector<int> types;
    std::vector<std::vector<Tag>> tags;
    std::vector<std::vector<Tag>> nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
    return !types.empty();
  }

  static std::vector<int> entities(int dimension) {
    gmsh::vectorpair pairs;
    gmsh::model::getEntities(pairs, dimension);
    std::vector<int> tags;
    for (const auto& [ignored, tag] : pairs) tags.push_back(tag);
    return tags;
  }

  struct Group {
    std::string name;
    std::vector<int> entities;
  };

  /// Named physical groups; those without a name, and names given twice, are problems.
  std::vector<Group> groups(int dimension, const std::string& what) {
    gmsh::vectorpair pairs;
    gmsh::model::getPhysicalGroups(pairs, dimension);
    std::vector<Group> groups;
    std::set<std::string> names;
    for (const auto& [ignored, tag] : pairs) {
      Group group;
      gmsh::model::getPhysicalName(dimension, tag, group.name);
      gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, group.entities);
      if (group.name.empty()) {
        report("physical " + what + " " + std::to_string(tag) + " without a name",
               "a name, as in Physical " + std::string(dimension == 2 ? "Surface" : "Curve") +
                   "(\"name\") = {...};");
      } else if (!is_plain_name(group.name)) {
        report(
            "physical " + what + " " + std::to_string(tag) + " with a name that is no plain text",
            "a name in UTF-8 of at most " + std::to_string(longest_name) +
                " bytes, without control characters");
      } else if (!names.insert(group.name).second) {
        report("two physical " + what + "s named \"" + group.name + "\"", "different names");
      } else {
        groups.push_back(std::move(group));
      }
    }
    return groups;
  }

  void read_surfaces() {
    const std::vector<Group> regions = groups(2, "surface");
    if (regions.empty()) {
      report("no named physical surface",
             "each region as a physical surface, as in Physical Surface(\"specimen\") = {1};" +
                 inventory({2, 1}));
      return;
    }
    std::map<int, std::vector<int>> regions_of;  // entity -> indices of regions
    for (std::size_t r = 0; r < regions.size(); ++r) {
      mesh().region_names.push_back(regions[r].name);
      for (int entity : regions[r].entities) regions_of[entity].push_back(static_cast<int>(r));
    }
    Kind wrong_types(result_.problems,
                     "triangles of three nodes (in Gmsh: Mesh.ElementOrder = 1, no Recombine)");
    region_has_elements_.assign(regions.size(), false);
    for (int entity : entities(2)) add_surface(entity, regions_of[entity], wrong_types);
    for (std::size_t r = 0; r < regions.size(); ++r) {
      if (region_has_elements_[r]) continue;
      report("physical surface \"" + regions[r].name + "\" without triangles",
             "a region that is not empty");
    }
  }

  void refuse_volumes() {
    const std::vector<int> volumes = entities(3);
    if (volumes.empty()) return;
    Kind kind(result_.problems, "a plane model: only triangles are supported so far");
    for (int volume : volumes) {
      read_entity(3, volume, gmsh_type::none, kind);
      if (!has_elements(3, volume)) kind.add("volume " + std::to_string(volume));
    }
  }

  void add_surface(int entity, const std::vector<int>& regions, Kind& wrong_types) {
    Elements triangles = read_entity(2, entity, gmsh_type::triangle, wrong_types);
    for (int region : regions) {
      region_has_elements_[region] = region_has_elements_[region] || has_elements(2, entity);
    }
    if (triangles.tags.empty()) return;
    const std::string which = "surface " + std::to_string(entity) + " (" +
                              std::to_string(triangles.tags.size()) + " triangles, one of them " +
                              std::to_string(triangles.tags.front()) + " at " +
                              place_of(triangles.nodes.front()) + ")";
    if (regions.empty()) report(which + " in no physical surface", "every triangle in one region");
    if (regions.size() > 1) {
      report(which + " in the physical surfaces \"" + mesh().region_names[regions[0]] +
                 "\" and \"" + mesh().region_names[regions[1]] + "\"",
             "every triangle in one region");
    }
    const int region = regions.empty() ? 0 : regions.front();
    for (std::size_t i = 0; i < triangles.tags.size(); ++i) {
      triangle_tags_.push_back(triangles.tags[i]);
      triangle_nodes_.push_back(
          {triangles.nodes[i][0], triangles.nodes[i][1], triangles.nodes[i][2]});
      mesh().element_region.push_back(region);
    }
  }

  /// What a user can name, when nothing is named.
  static std::string inventory(const std::vector<int>& dimensions) {
    std::string text;
    for (const int dimension : dimensions) {
      for (int entity : entities(dimension)) {
        std::array<double, 6> box{};
        gmsh::model::getBoundingBox(dimension, entity, box[0], box[1], box[2], box[3], box[4],
                                    box[5]);
        const auto rounded = [](double value) {
          return short_number(std::round(value * 1e6) / 1e6);
        };
        text += "\n    " + std::string(dimension == 2 ? "surface " : "curve ") +
                std::to_string(entity) + ": x " + rounded(box[0]) + " to " + rounded(box[3]) +
                ", y " + rounded(box[1]) + " to " + rounded(box[4]);
      }
    }
    return text.empty() ? "" : " the model has" + text;
  }

  /// Ascending tags become indices.
  void number_nodes() {
    std::set<Tag> used;
    for (const auto& nodes : triangle_nodes_) used.insert(nodes.begin(), nodes.end());
    for (Tag tag : used) {
      index_[tag] = mesh().node_count();
      node_tags_.push_back(tag);
      const auto& x = coordinates_.at(tag);
      mesh().nodes.emplace_back(x[0], x[1]);
    }
    for (const auto& nodes : triangle_nodes_) {
      mesh().elements.push_back({index_.at(nodes[0]), index_.at(nodes[1]), index_.at(nodes[2])});
    }
    Vector<2> low = mesh().nodes.front();
    Vector<2> high = low;
    for (const Vector<2>& x : mesh().nodes) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    diagonal_ = (high - low).norm();
  }

  /// Whether all nodes are somewhere; those that are not are problems.
  bool has_coordinates() {
    Kind kind(result_.problems, "finite coordinates, in m, below " + short_number(max_coordinate));
    bool all = true;
    for (Tag tag : node_tags_) {
      const auto& x = coordinates_.at(tag);
      const auto is_near = [](double value) { return std::abs(value) <= max_coordinate; };
      if (std::ranges::all_of(x, is_near)) continue;
      all = false;
      kind.add("node " + std::to_string(tag) + " at (" + short_number(x[0]) + ", " +
               short_number(x[1]) + ", " + short_number(x[2]) + ")");
    }
    return all;
  }

  void check_plane() {
    Kind kind(result_.problems, "a mesh in the plane z = 0");
    for (Tag tag : node_tags_) {
      const auto& x = coordinates_.at(tag);
      if (std::abs(x[2]) <= out_of_plane * diagonal_) continue;
      kind.add("node " + std::to_string(tag) + " at (" + short_number(x[0]) + ", " +
               short_number(x[1]) + ", " + short_number(x[2]) + ")");
    }
  }

  void check_duplicate_nodes() {
    Kind kind(result_.problems,
              "one node per place, so that neighbours are connected (in Gmsh: Coherence; or "
              "BooleanFragments, or Coherence Mesh)");
    const double tolerance = same_place * diagonal_;
    if (!(tolerance > 0.0)) return;
    // Cells of the size of the tolerance: a node's duplicates are in its own or the next ones.
    std::map<std::pair<std::int64_t, std::int64_t>, int> cells;
    const Vector<2> origin = mesh().nodes.front();
    for (int n = 0; n < mesh().node_count(); ++n) {
      const Vector<2> offset = (mesh().nodes[n] - origin) / tolerance;
      const std::int64_t i = std::llround(offset[0]);
      const std::int64_t j = std::llround(offset[1]);
      for (std::int64_t di = -1; di <= 1; ++di) {
        for (std::int64_t dj = -1; dj <= 1; ++dj) {
          const auto other = cells.find({i + di, j + dj});
          if (other == cells.end()) continue;
          if ((mesh().nodes[other->second] - mesh().nodes[n]).norm() > tolerance) continue;
          kind.add("nodes " + std::to_string(node_tags_[other->second]) + " and " +
                   std::to_string(node_tags_[n]) + ", both at " + place(mesh().nodes[n]));
        }
      }
      cells.emplace(std::pair(i, j), n);
    }
  }

  void orient_and_check_areas() {
    Kind kind(result_.problems, "triangles with an area");
    for (int e = 0; e < mesh().element_count(); ++e) {
      auto& corners = mesh().elements[e];
      double longest = 0.0;
      for (int a = 0; a < 3; ++a) {
        longest = std::max(
            longest, (mesh().nodes[corners[(a + 1) % 3]] - mesh().nodes[corners[a]]).squaredNorm());
      }
      const double area = element_volume(mesh(), e);
      if (!(std::abs(area) > smallest_area * longest)) {
        kind.add("element " + std::to_string(triangle_tags_[e]) + ", flat, with its nodes at " +
                 place(mesh().nodes[corners[0]]) + ", " + place(mesh().nodes[corners[1]]) + ", " +
                 place(mesh().nodes[corners[2]]));
        flat_.insert(e);
      } else if (area < 0.0) {
        std::swap(corners[1], corners[2]);
        ++result_.turned;
      }
    }
  }

  /// All triangles being counter-clockwise, two neighbours run along their edge in opposite
  /// directions. Those that run in the same one lie on the same side of it.
  void check_overlaps() {
    Kind kind(result_.problems,
              "triangles that do not overlap: the mesh is folded or has one twice");
    std::map<std::array<int, 2>, int> owner;  // by directed edge
    for (int e = 0; e < mesh().element_count(); ++e) {
      if (flat_.contains(e)) continue;
      const auto& corners = mesh().elements[e];
      for (int a = 0; a < 3; ++a) {
        const std::array<int, 2> edge{corners[a], corners[(a + 1) % 3]};
        const auto [entry, is_new] = owner.emplace(edge, e);
        if (is_new) continue;
        kind.add("elements " + std::to_string(triangle_tags_[entry->second]) + " and " +
                 std::to_string(triangle_tags_[e]) + ", on the same side of the edge from " +
                 place(mesh().nodes[edge[0]]) + " to " + place(mesh().nodes[edge[1]]));
        break;
      }
    }
  }

  [[nodiscard]] OuterEdges edges_of_one_triangle() const {
    OuterEdges outer;
    for (int e = 0; e < result_.mesh.element_count(); ++e) {
      for (int corner = 0; corner < 3; ++corner) {
        const auto edge = face_key<2>(face_opposite<2>(result_.mesh.elements[e], corner));
        const auto [entry, is_new] = outer.emplace(edge, e);
        if (!is_new) outer.erase(entry);
      }
    }
    return outer;
  }

  /// A node in the middle of a neighbour's edge connects nothing: what looks like one body would be
  /// two, with an impervious joint.
  void check_hanging_nodes(const OuterEdges& outer) {
    Kind kind(result_.problems,
              "neighbours that share whole edges (in Gmsh: Coherence, or BooleanFragments)");
    std::set<int> nodes;
    for (const auto& [edge, element] : outer) nodes.insert(edge.begin(), edge.end());
    std::vector<int> by_x(nodes.begin(), nodes.end());
    const auto& x = mesh().nodes;
    std::ranges::sort(by_x, {}, [&](int n) { return x[n][0]; });
    const double tolerance = same_place * diagonal_;
    for (const auto& [edge, element] : outer) {
      if (flat_.contains(element)) continue;
      const Vector<2> start = x[edge[0]];
      const Vector<2> along = (x[edge[1]] - start).normalized();
      const double length = (x[edge[1]] - start).norm();
      const auto [left, right] = std::minmax(start[0], x[edge[1]][0]);
      for (auto n =
               std::ranges::lower_bound(by_x, left - tolerance, {}, [&](int m) { return x[m][0]; });
           n != by_x.end() && x[*n][0] <= right + tolerance; ++n) {
        const Vector<2> offset = x[*n] - start;
        const double from_start = offset.dot(along);
        const double aside = std::abs(offset[0] * along[1] - offset[1] * along[0]);
        const bool within = from_start > tolerance && from_start < length - tolerance;
        if (!within || aside > tolerance) continue;
        kind.add("node " + std::to_string(node_tags_[*n]) + " at " + place(x[*n]) +
                 " on the edge of element " + std::to_string(triangle_tags_[element]) + " from " +
                 place(start) + " to " + place(x[edge[1]]));
      }
    }
  }

  /// Parts that share no edge and yet lie on each other: their outer edges cross, or one lies
  /// within an element of the other.
  void check_parts(const OuterEdges& outer) {
    Kind kind(result_.problems,
              "parts that do not lie on each other (in Gmsh: Coherence, or BooleanFragments)");
    check_crossings(outer, kind);
    const std::vector<int> part = parts();
    std::map<int, int> corner_of_part;
    for (const auto& [edge, element] : outer) corner_of_part.emplace(part[element], edge[0]);
    if (corner_of_part.size() < 2) return;
    const auto& x = mesh().nodes;
    std::vector<std::pair<int, int>> by_x(corner_of_part.begin(), corner_of_part.end());
    const auto abscissa = [&](const std::pair<int, int>& corner) { return x[corner.second][0]; };
    std::ranges::sort(by_x, {}, abscissa);
    for (int e = 0; e < mesh().element_count(); ++e) {
      if (flat_.contains(e)) continue;
      const auto& [a, b, c] = mesh().elements[e];
      const auto [left, right] = std::minmax({x[a][0], x[b][0], x[c][0]});
      for (auto corner = std::ranges::lower_bound(by_x, left, {}, abscissa);
           corner != by_x.end() && abscissa(*corner) <= right; ++corner) {
        const auto [own, node] = *corner;
        if (part[e] == own || !lies_within(x[node], e)) continue;
        kind.add("node " + std::to_string(node_tags_[node]) + " at " + place(x[node]) +
                 " within element " + std::to_string(triangle_tags_[e]) + " of another part");
      }
    }
  }

  void check_crossings(const OuterEdges& outer, Kind& kind) {
    struct Edge {
      Vector<2> from;
      Vector<2> to;
      int element;
    };
    const auto left = [](const Edge& edge) { return std::min(edge.from[0], edge.to[0]); };
    const auto right = [](const Edge& edge) { return std::max(edge.from[0], edge.to[0]); };
    std::vector<Edge> edges;
    for (const auto& [nodes, element] : outer) {
      if (!flat_.contains(element)) {
        edges.push_back({mesh().nodes[nodes[0]], mesh().nodes[nodes[1]], element});
      }
    }
    std::ranges::sort(edges, {}, left);
    const double tolerance = same_place * diagonal_;
    // Both ends of each on different sides of the other, by more than round-off.
    const auto separates_ends_of = [&](const Edge& line, const Edge& other) {
      const Vector<2> along = (line.to - line.from).normalized();
      const auto aside = [&](const Vector<2>& x) {
        const Vector<2> offset = x - line.from;
        return along[0] * offset[1] - along[1] * offset[0];
      };
      const double a = aside(other.from);
      const double b = aside(other.to);
      return std::min(a, b) < -tolerance && std::max(a, b) > tolerance;
    };
    for (std::size_t i = 0; i < edges.size(); ++i) {
      for (std::size_t j = i + 1; j < edges.size() && left(edges[j]) < right(edges[i]); ++j) {
        if (!separates_ends_of(edges[i], edges[j]) || !separates_ends_of(edges[j], edges[i]))
          continue;
        kind.add("elements " + std::to_string(triangle_tags_[edges[i].element]) + " and " +
                 std::to_string(triangle_tags_[edges[j].element]) + ", whose edges from " +
                 place(edges[i].from) + " to " + place(edges[i].to) + " and from " +
                 place(edges[j].from) + " to " + place(edges[j].to) + " cross");
      }
    }
  }

  /// Per element, the number of the part that it belongs to: those that share an edge are of one.
  [[nodiscard]] std::vector<int> parts() const {
    std::vector<int> part(result_.mesh.element_count());
    std::iota(part.begin(), part.end(), 0);
    const auto root = [&](int e) {
      while (part[e] != e) e = part[e] = part[part[e]];
      return e;
    };
    std::map<std::array<int, 2>, int> owner;
    for (int e = 0; e < result_.mesh.element_count(); ++e) {
      for (int corner = 0; corner < 3; ++corner) {
        const auto edge = face_key<2>(face_opposite<2>(result_.mesh.elements[e], corner));
        const auto [entry, is_new] = owner.emplace(edge, e);
        if (!is_new) part[root(e)] = root(entry->second);
      }
    }
    for (int e = 0; e < result_.mesh.element_count(); ++e) part[e] = root(e);
    return part;
  }

  /// Farther from each of its edges than the tolerance.
  [[nodiscard]] bool lies_within(const Vector<2>& x, int element) const {
    const double tolerance = same_place * diagonal_;
    const auto& corners = result_.mesh.elements[element];
    for (int a = 0; a < 3; ++a) {
      const Vector<2>& start = result_.mesh.nodes[corners[a]];
      const Vector<2> along = (result_.mesh.nodes[corners[(a + 1) % 3]] - start).normalized();
      const Vector<2> offset = x - start;
      if (!(along[0] * offset[1] - along[1] * offset[0] > tolerance)) return false;
    }
    return true;
  }

  void read_boundaries() {
    gmsh::vectorpair named;
    gmsh::model::getPhysicalGroups(named, 1);
    if (named.empty()) result_.curves_to_name = inventory({1});
    const FaceTable<2> faces(mesh());
    Kind wrong_types(result_.problems, "edges of two nodes (in Gmsh: Mesh.ElementOrder = 1)");
    for (const Group& group : groups(1, "curve")) {
      Elements edges;
      for (int entity : group.entities) {
        Elements more = read_entity(1, entity, gmsh_type::line, wrong_types);
        edges.tags.insert(edges.tags.end(), more.tags.begin(), more.tags.end());
        edges.nodes.insert(edges.nodes.end(), more.nodes.begin(), more.nodes.end());
      }
      if (edges.tags.empty()) {
        report("physical curve \"" + group.name + "\" without edges",
               "a boundary that is not empty");
      }
      add_curve(group.name, edges, faces);
    }
  }

  /// A curve is a boundary, or lies inside the mesh as a whole.
  void add_curve(const std::string& name, const Elements& edges, const FaceTable<2>& faces) {
    std::set<std::array<int, 2>> outer;
    std::set<std::array<int, 2>> inner;
    std::vector<const std::vector<Tag>*> inner_tags;
    Kind kind(result_.problems, "a boundary of outer edges only");
    for (const auto& nodes : edges.nodes) {
      const auto first = index_.find(nodes[0]);
      const auto second = index_.find(nodes[1]);
      const bool known = first != index_.end() && second != index_.end();
      const std::array<int, 2> edge =
          known ? face_key<2>({first->second, second->second}) : std::array<int, 2>{-1, -1};
      const int owners = known ? faces.owners(edge) : 0;
      if (owners == 0) {
        kind.add("physical curve \"" + name + "\" with an edge at " + place_of(nodes) +
                 " that no triangle has");
      }
      if (owners == 1) outer.insert(edge);
      if (owners > 1 && inner.insert(edge).second) inner_tags.push_back(&nodes);
    }
    if (outer.empty() && !inner.empty()) {
      result_.inner_curves.push_back({name, {inner.begin(), inner.end()}});
      return;
    }
    for (const auto* nodes : inner_tags) {
      kind.add("physical curve \"" + name + "\" with an edge at " + place_of(*nodes) +
               " that lies inside the mesh");
    }
    mesh().boundaries.push_back({name, {outer.begin(), outer.end()}});
  }

  /// Points without a name, or off the mesh, are of no use to anybody: they may be there for
  /// something else.
  void read_points() {
    gmsh::vectorpair pairs;
    gmsh::model::getPhysicalGroups(pairs, 0);
    for (const auto& [ignored, tag] : pairs) {
      std::string name;
      gmsh::model::getPhysicalName(0, tag, name);
      std::vector<Tag> nodes;
      std::vector<double> coordinates;
      gmsh::model::mesh::getNodesForPhysicalGroup(0, tag, nodes, coordinates);
      if (name.empty() || !is_plain_name(name) || nodes.size() != 1) continue;
      const auto node = index_.find(nodes.front());
      if (node != index_.end()) result_.points.push_back({name, node->second});
    }
  }

  ExtractedMesh result_;
  Quadrangles quadrangles_;
  Tag last_tag_ = 0;  // of a node
  std::unordered_map<Tag, std::array<double, 3>> coordinates_;
  std::unordered_map<Tag, int> index_;
  std::vector<Tag> node_tags_;  // by index
  std::vector<Tag> triangle_tags_;
  std::vector<std::array<Tag, 3>> triangle_nodes_;
  std::vector<bool> region_has_elements_;
  std::set<int> flat_;  // elements
  double diagonal_ = 0.0;
};

}  // namespace

ExtractedMesh extract_mesh(Quadrangles quadrangles) {
  return Extraction(quadrangles).run();
}

}  // namespace suffuse

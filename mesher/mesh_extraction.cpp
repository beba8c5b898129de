#include "mesh_extraction.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

#include "common/closest_name.hpp"
#include "common/short_number.hpp"
#include "gmsh_types.hpp"
#include "mesh/faces.hpp"
#include "mesh_checks.hpp"
#include "mesh_problems.hpp"

namespace suffuse {

namespace {

using Tag = std::size_t;

/// Relative to the diagonal of the mesh.
constexpr double out_of_plane = 1e-9;
/// Largest coordinate, m: the square of an area, a product of four lengths, is still finite.
constexpr double max_coordinate = 1e50;
/// Bytes.
constexpr std::size_t longest_name = 127;
/// Whether a name can be in files, tables and messages: UTF-8 without control characters.
bool is_plain_name(const std::string& name) {
  std::size_t expected = 0;  // missing bytes of the current character
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

struct Elements {
  std::vector<Tag> tags;
  std::vector<std::vector<Tag>> nodes;
};

template <int Dim>
class Extraction {
 public:
  Extraction(const GmshModel& model, Quadrangles quadrangles)
      : model_(model), quadrangles_(quadrangles) {}

  ExtractedMesh<Dim> run() {
    read_nodes();
    read_regions();
    if (tags_.elements.empty()) return std::move(result_);
    number_nodes();
    if (!has_coordinates()) return std::move(result_);
    result_.comparable = true;
    if (Dim == 2) check_plane();
    result_.turned = check_mesh(mesh(), tags_, result_.problems);
    read_boundaries();
    read_points();
    return std::move(result_);
  }

 private:
  using Words = MeshWords<Dim>;
  using Side = std::array<int, Dim>;

  static constexpr int simplex = Dim == 2 ? gmsh_type::triangle : gmsh_type::tetrahedron;
  static constexpr int simplex_side = Dim == 2 ? gmsh_type::line : gmsh_type::triangle;

  Mesh<Dim>& mesh() { return result_.mesh; }

  void report(const std::string& found, const std::string& expected) {
    result_.problems.push_back({"", "", found, expected, ""});
  }

  void read_nodes() {
    const std::vector<Tag>& tags = model_.node_tags;
    const std::vector<double>& x = model_.coordinates;
    coordinates_.reserve(tags.size());
    for (std::size_t i = 0; i < tags.size(); ++i) {
      coordinates_[tags[i]] = {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
      last_tag_ = std::max(last_tag_, tags[i]);
    }
  }

  [[nodiscard]] Vector<Dim> position(Tag node) const {
    const std::array<double, 3>& x = coordinates_.at(node);
    return Eigen::Map<const Vector<Dim>>(x.data());
  }

  [[nodiscard]] std::string place_of(const std::vector<Tag>& nodes) const {
    Vector<Dim> centre = Vector<Dim>::Zero();
    for (Tag node : nodes) centre += position(node) / static_cast<double>(nodes.size());
    return place_text<Dim>(centre);
  }

  /// The entity, or null if Gmsh has none.
  [[nodiscard]] const GmshEntity* find_entity(int dimension, int tag) const {
    const auto found = std::ranges::find_if(model_.entities, [&](const GmshEntity& entity) {
      return entity.dimension == dimension && entity.tag == tag;
    });
    return found == model_.entities.end() ? nullptr : &*found;
  }

  /// The elements of an entity that have the required type; others are problems.
  Elements read_entity(const GmshEntity& entity, int wanted, ProblemKind& wrong_types) {
    Elements result;
    for (const GmshElements& block : entity.elements) {
      for (std::size_t i = 0; i < block.tags.size(); ++i) {
        const auto first = block.nodes.begin() + static_cast<std::ptrdiff_t>(i) * block.nodes_each;
        std::vector<Tag> corners(first, first + block.nodes_each);
        if constexpr (Dim == 2) {
          if (block.type == gmsh_type::quadrangle && wanted == gmsh_type::triangle &&
              quadrangles_ == Quadrangles::cut_along_diagonals) {
            cut(block.tags[i], corners, result);
            continue;
          }
        }
        if (block.type != wanted) {
          wrong_types.add("element " + std::to_string(block.tags[i]) + " (" + block.type_name +
                          ") at " + place_of(corners));
          continue;
        }
        result.tags.push_back(block.tags[i]);
        result.nodes.push_back(std::move(corners));
      }
    }
    return result;
  }

  /// Adds the four triangles of a quadrangle, with a node where its diagonals cross.
  void cut(Tag tag, const std::vector<Tag>& corners, Elements& result) {
    std::array<Vector<2>, 4> x;
    for (int a = 0; a < 4; ++a) x[a] = position(corners[a]);
    const Vector<2> first = x[2] - x[0];
    const Vector<2> second = x[3] - x[1];
    const Vector<2> between = x[1] - x[0];
    const double share = (between[0] * second[1] - between[1] * second[0]) /
                         (first[0] * second[1] - first[1] * second[0]);
    // Outside (0, 1) the quadrangle is not convex; its mean point then shows its place.
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

  /// The word for an entity in a .geo file.
  static std::string script_word(int dimension) {
    return dimension == 3 ? "Volume" : dimension == 2 ? "Surface" : "Curve";
  }

  /// Named physical groups; those without a name, and names given twice, are problems.
  std::vector<const GmshGroup*> groups(int dimension, const std::string& what) {
    std::vector<const GmshGroup*> groups;
    std::set<std::string> names;
    for (const GmshGroup& group : model_.groups) {
      if (group.dimension != dimension) continue;
      const std::string which = "physical " + what + " " + std::to_string(group.tag);
      if (group.name.empty()) {
        report(which + " without a name",
               "a name, as in Physical " + script_word(dimension) + "(\"name\") = {...};");
      } else if (!is_plain_name(group.name)) {
        report(which + " with a name that is no plain text",
               "a name in UTF-8 of at most " + std::to_string(longest_name) +
                   " bytes, without control characters");
      } else if (!names.insert(group.name).second) {
        report("two physical " + what + "s named \"" + group.name + "\"", "different names");
      } else {
        groups.push_back(&group);
      }
    }
    return groups;
  }

  void read_regions() {
    const std::string region = Words::region;
    const std::vector<const GmshGroup*> regions = groups(Dim, region);
    if (regions.empty()) {
      report("no named physical " + region,
             "each region as a physical " + region + ", as in Physical " + script_word(Dim) +
                 "(\"specimen\") = {1};" + inventory({Dim, Dim - 1}));
      return;
    }
    std::map<int, std::vector<int>> regions_of;  // entity -> indices of regions
    for (std::size_t r = 0; r < regions.size(); ++r) {
      mesh().region_names.push_back(regions[r]->name);
      for (int entity : regions[r]->entities) regions_of[entity].push_back(static_cast<int>(r));
    }
    ProblemKind wrong_types(result_.problems,
                            std::string(Words::elements) + " of " + (Dim == 2 ? "three" : "four") +
                                " nodes (in Gmsh: Mesh.ElementOrder = 1, no Recombine)");
    region_has_elements_.assign(regions.size(), false);
    for (const GmshEntity& entity : model_.entities) {
      if (entity.dimension == Dim) add_entity(entity, regions_of[entity.tag], wrong_types);
    }
    for (std::size_t r = 0; r < regions.size(); ++r) {
      if (region_has_elements_[r]) continue;
      report("physical " + region + " \"" + regions[r]->name + "\" without " + Words::elements,
             "a region that is not empty");
    }
  }

  void add_entity(const GmshEntity& entity, const std::vector<int>& regions,
                  ProblemKind& wrong_types) {
    const Elements found = read_entity(entity, simplex, wrong_types);
    for (int region : regions) {
      region_has_elements_[region] = region_has_elements_[region] || !entity.elements.empty();
    }
    if (found.tags.empty()) return;
    const std::string word = Words::region;
    const std::string which = word + " " + std::to_string(entity.tag) + " (" +
                              std::to_string(found.tags.size()) + " " + Words::elements +
                              ", one of them " + std::to_string(found.tags.front()) + " at " +
                              place_of(found.nodes.front()) + ")";
    const std::string expected = std::string("every ") + Words::element + " in one region";
    if (regions.empty()) report(which + " in no physical " + word, expected);
    if (regions.size() > 1) {
      report(which + " in the physical " + word + "s \"" + mesh().region_names[regions[0]] +
                 "\" and \"" + mesh().region_names[regions[1]] + "\"",
             expected);
    }
    tags_.elements.insert(tags_.elements.end(), found.tags.begin(), found.tags.end());
    element_nodes_.insert(element_nodes_.end(), found.nodes.begin(), found.nodes.end());
    mesh().element_region.resize(tags_.elements.size(), regions.empty() ? 0 : regions.front());
  }

  /// List of the entities that a user can name, if none has a name.
  [[nodiscard]] std::string inventory(const std::vector<int>& dimensions) const {
    std::string text;
    for (const int dimension : dimensions) {
      for (const GmshEntity& entity : model_.entities) {
        if (entity.dimension != dimension || entity.elements.empty()) continue;
        const auto rounded = [&entity](std::size_t i) {
          return short_number(std::round(entity.box[i] * 1e6) / 1e6);
        };
        std::string word = script_word(dimension);
        word[0] = static_cast<char>(std::tolower(word[0]));
        text += "\n    " + word + " " + std::to_string(entity.tag) + ": x " + rounded(0) + " to " +
                rounded(3) + ", y " + rounded(1) + " to " + rounded(4);
        if (Dim == 3) text += ", z " + rounded(2) + " to " + rounded(5);
      }
    }
    return text.empty() ? "" : " the model has" + text;
  }

  /// Numbers the nodes by ascending tags.
  void number_nodes() {
    std::set<Tag> used;
    for (const auto& nodes : element_nodes_) used.insert(nodes.begin(), nodes.end());
    for (Tag tag : used) {
      index_[tag] = mesh().node_count();
      tags_.nodes.push_back(tag);
      mesh().nodes.push_back(position(tag));
    }
    for (const auto& nodes : element_nodes_) {
      auto& element = mesh().elements.emplace_back();
      for (int a = 0; a <= Dim; ++a) element[a] = index_.at(nodes[a]);
    }
  }

  /// Whether all nodes have usable coordinates; those without are problems.
  bool has_coordinates() {
    ProblemKind kind(result_.problems,
                     "finite coordinates, in m, below " + short_number(max_coordinate));
    bool all = true;
    for (Tag tag : tags_.nodes) {
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
    const double diagonal = extent(mesh()).norm();
    ProblemKind kind(result_.problems, "a mesh in the plane z = 0");
    for (Tag tag : tags_.nodes) {
      const auto& x = coordinates_.at(tag);
      if (std::abs(x[2]) <= out_of_plane * diagonal) continue;
      kind.add("node " + std::to_string(tag) + " at (" + short_number(x[0]) + ", " +
               short_number(x[1]) + ", " + short_number(x[2]) + ")");
    }
  }

  void read_boundaries() {
    const std::string word = Words::boundary;
    const bool has_groups = std::ranges::any_of(
        model_.groups, [](const GmshGroup& group) { return group.dimension == Dim - 1; });
    if (!has_groups) result_.curves_to_name = inventory({Dim - 1});
    const FaceTable<Dim> faces(mesh());
    ProblemKind wrong_types(result_.problems, std::string(Words::sides) + " of " +
                                                  (Dim == 2 ? "two" : "three") +
                                                  " nodes (in Gmsh: Mesh.ElementOrder = 1)");
    for (const GmshGroup* group : groups(Dim - 1, word)) {
      std::vector<std::vector<Tag>> sides;
      for (const int tag : group->entities) {
        const GmshEntity* entity = find_entity(Dim - 1, tag);
        if (entity == nullptr) continue;
        Elements more = read_entity(*entity, simplex_side, wrong_types);
        std::ranges::move(more.nodes, std::back_inserter(sides));
      }
      if (sides.empty()) {
        report("physical " + word + " \"" + group->name + "\" without " + Words::sides,
               "a boundary that is not empty");
      }
      add_boundary(group->name, sides, faces);
    }
  }

  /// The side with these nodes, by their indices, if an element has all of them.
  [[nodiscard]] std::optional<Side> side_of(const std::vector<Tag>& nodes) const {
    Side side{};
    for (int a = 0; a < Dim; ++a) {
      const auto found = index_.find(nodes[a]);
      if (found == index_.end()) return std::nullopt;
      side[a] = found->second;
    }
    return face_key<Dim>(side);
  }

  /// Adds a curve (surface), which must be a boundary or be inside the mesh as a whole.
  void add_boundary(const std::string& name, const std::vector<std::vector<Tag>>& sides,
                    const FaceTable<Dim>& faces) {
    std::set<Side> outer;
    std::set<Side> inner;
    std::vector<const std::vector<Tag>*> inner_tags;
    ProblemKind kind(result_.problems,
                     std::string("a boundary of outer ") + Words::sides + " only");
    const std::string with_side = std::string("physical ") + Words::boundary + " \"" + name +
                                  "\" with " + (Dim == 2 ? "an " : "a ") + Words::side + " at ";
    for (const auto& nodes : sides) {
      const std::optional<Side> side = side_of(nodes);
      const int owners = side ? faces.owners(*side) : 0;
      if (owners == 0)
        kind.add(with_side + place_of(nodes) + " that no " + Words::element + " has");
      if (owners == 1) outer.insert(*side);
      if (owners > 1 && inner.insert(*side).second) inner_tags.push_back(&nodes);
    }
    if (outer.empty() && !inner.empty()) {
      result_.inner_curves.push_back({name, {inner.begin(), inner.end()}});
      return;
    }
    for (const auto* nodes : inner_tags) {
      kind.add(with_side + place_of(*nodes) + " that lies inside the mesh");
    }
    mesh().boundaries.push_back({name, {outer.begin(), outer.end()}});
  }

  /// Reads the named points of the mesh. Points without a name, or off the mesh, are ignored: they
  /// may have another purpose.
  void read_points() {
    for (const GmshGroup& group : model_.groups) {
      if (group.dimension != 0 || group.nodes.size() != 1) continue;
      if (group.name.empty() || !is_plain_name(group.name)) continue;
      const auto node = index_.find(group.nodes.front());
      if (node != index_.end()) result_.points.push_back({group.name, node->second});
    }
  }

  const GmshModel& model_;
  ExtractedMesh<Dim> result_;
  Quadrangles quadrangles_;
  Tag last_tag_ = 0;  // largest tag of a node
  std::unordered_map<Tag, std::array<double, 3>> coordinates_;
  std::unordered_map<Tag, int> index_;
  MeshTags tags_;
  std::vector<std::vector<Tag>> element_nodes_;
  std::vector<bool> region_has_elements_;
};

}  // namespace

template <int Dim>
ExtractedMesh<Dim> extract_mesh(const GmshModel& model, Quadrangles quadrangles) {
  return Extraction<Dim>(model, quadrangles).run();
}

template ExtractedMesh<2> extract_mesh(const GmshModel&, Quadrangles);
template ExtractedMesh<3> extract_mesh(const GmshModel&, Quadrangles);

}  // namespace suffuse

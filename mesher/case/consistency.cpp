#include "case/consistency.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "common/closest_name.hpp"
#include "common/short_number.hpp"
#include "mesh/faces.hpp"
#include "mesh/mesh_pieces.hpp"
#include "mesh/place_text.hpp"
#include "mesh/slit.hpp"
#include "mesh/water_line.hpp"
#include "physics/head.hpp"

namespace suffuse {

namespace {

/// Round-off of n_0 + gradient . (x - origin), so that a gradient may end exactly on a bound.
constexpr double porosity_round_off = 1e-12;

/// Round-off of a place on the border of the mesh, relative to an element.
constexpr double on_the_edge = 1e-9;

constexpr auto needs_three = "three numbers: the mesh is three-dimensional";

std::string in_quotes(const std::string& name) {
  return '"' + name + '"';
}

/// Whether a condition decides at which level steady flow under gravity stands.
bool sets_level(const BoundaryCondition& b) {
  return b.head || b.pressure || b.seepage_face || b.rain;
}

template <int Dim>
class SceneCheck {
 public:
  SceneCheck(const SceneDocument& document, const Mesh<Dim>& mesh, const InnerNames& inner)
      : document_(document), mesh_(mesh), curves_(inner.curves) {
    for (const auto& set : mesh.boundaries) {
      (is_slit(mesh, set) ? slit_ : outer_).push_back(set.name);
    }
    const auto knows = [](const std::vector<std::string>& names, const std::string& name) {
      return std::ranges::find(names, name) != names.end();
    };
    for (const std::string& name : slit_) {
      if (!knows(inner.points, name) && !knows(curves_, name)) curves_.push_back(name);
    }
    inner_ = curves_;
    inner_.insert(inner_.end(), inner.points.begin(), inner.points.end());
  }

  std::vector<InputProblem> run() {
    check_directions();
    check_gauss_points();
    if (Dim == 3) refuse_what_is_plane();
    check_soils();
    check_regions();
    check_boundaries();
    check_walls();
    check_levels();
    check_explicit_heads();
    check_outputs();
    return std::move(problems_);
  }

 private:
  void report(const std::string& key, const std::string& found, const std::string& expected,
              const std::string& suggestion = "") {
    problems_.push_back({document_.locate(key), key, found, expected, suggestion});
  }

  static std::string suggest(const std::string& name, const std::vector<std::string>& names) {
    const std::string closest = closest_name(name, names);
    return closest.empty() ? "" : in_quotes(closest);
  }

  /// Refuses a third component, for example of gravity, which has no effect in two dimensions.
  void check_two_dimensional(const std::string& key, const std::array<double, 3>& value) {
    if (Dim == 2 && value[2] != 0.0) {
      report(key, "a third number, " + short_number(value[2]),
             "two numbers: the mesh is two-dimensional");
    }
  }

  void check_directions() {
    for (const std::string& key : document_.plane_vectors) {
      if (Dim == 3) report(key, "two numbers, of x and y", needs_three);
    }
    check_two_dimensional("gravity", document_.scene.gravity);
    for (const Soil& soil : document_.scene.soils) {
      check_two_dimensional("soil." + soil.region + ".porosity_gradient", soil.porosity_gradient);
      check_two_dimensional("soil." + soil.region + ".porosity_origin", soil.porosity_origin);
    }
    for (const BoundaryCondition& boundary : document_.scene.boundaries) {
      if (Dim == 2 || !boundary.traction || boundary.traction->given == 3) continue;
      report(boundary.key + ".traction", "two numbers, of x and y", needs_three);
    }
  }

  void check_gauss_points() {
    const PointSettings& points = document_.scene.points;
    check_rule("points.solid_per_element", points.solid_per_element);
    if (points.seeding == Seeding::gauss) {
      check_rule("points.liquid_per_element", points.liquid_per_element);
    }
  }

  void check_rule(const std::string& key, int count) {
    const std::set<int> known = Dim == 2 ? std::set{1, 3, 6, 12} : std::set{1, 4, 14};
    if (known.contains(count)) return;
    report(key,
           std::to_string(count) + " Gauss points in a " + (Dim == 2 ? "triangle" : "tetrahedron"),
           Dim == 2 ? "1, 3, 6 or 12" : "1, 4 or 14");
  }

  void refuse_what_is_plane() {
    const Scene& scene = document_.scene;
    const std::string only = " in two dimensions only";
    if (scene.moves() && scene.formulation == Formulation::double_point) {
      report("formulation", "\"double-point\" with a skeleton that moves, in three dimensions",
             "\"single-point\", or a rigid skeleton: double-point runs move soil" + only);
    }
    if (scene.time.scheme == FlowScheme::explicit_nodal) {
      report("time.scheme", "\"explicit\" in three dimensions",
             "\"implicit\": the explicit scheme is for meshes of triangles alone");
    }
    if (!scene.output.sections.empty()) {
      report("output.section", "a section in three dimensions",
             "no such entry: discharges across a line are recorded" + only +
                 ", those across boundaries in any case");
    }
  }

  void check_soils() {
    for (const Soil& soil : document_.scene.soils) {
      const auto region = std::ranges::find(mesh_.region_names, soil.region);
      if (region == mesh_.region_names.end()) {
        report_no_region(soil.region);
      } else {
        check_porosity(soil, static_cast<int>(region - mesh_.region_names.begin()));
      }
    }
    for (const std::string& region : document_.scene.free_regions) {
      if (std::ranges::count(mesh_.region_names, region) == 0) report_no_region(region);
    }
  }

  void report_no_region(const std::string& name) {
    const std::string meant = closest_name(name, regions_without_soil());
    meant_.insert(meant);
    report("soil." + name, in_quotes(name),
           "a region of the mesh: " + quoted_list(mesh_.region_names),
           meant.empty() ? "" : in_quotes(meant));
  }

  [[nodiscard]] std::vector<std::string> regions_without_soil() const {
    std::vector<std::string> regions = mesh_.region_names;
    const Scene& scene = document_.scene;
    std::erase_if(regions, [&](const std::string& region) {
      return scene.find_soil(region) != nullptr || scene.is_free_water(region);
    });
    return regions;
  }

  void check_regions() {
    std::vector<std::string> soils;
    for (const Soil& soil : document_.scene.soils) soils.push_back(soil.region);
    for (const std::string& region : regions_without_soil()) {
      if (meant_.contains(region)) continue;  // reported with the soil that has nearly its name
      std::string expected = "a table [soil." + region + "] for the mesh's region of that name";
      if (names_free_water(region)) {
        expected +=
            ", or formulation = \"double-point\" or a skeleton that moves, where it is free "
            "water without one";
      }
      expected += "; the soils are " + quoted_list(soils);
      report("soil." + region, "nothing", expected, suggest(region, soils));
    }
  }

  /// n_0 is linear: its extremes over a region are at nodes.
  void check_porosity(const Soil& soil, int region) {
    int lowest = -1;
    int highest = -1;
    const auto porosity = [&](int node) { return soil.initial_porosity(mesh_.nodes[node]); };
    for (int e = 0; e < mesh_.element_count(); ++e) {
      if (mesh_.element_region[e] != region) continue;
      for (int node : mesh_.elements[e]) {
        if (lowest < 0 || porosity(node) < porosity(lowest)) lowest = node;
        if (highest < 0 || porosity(node) > porosity(highest)) highest = node;
      }
    }
    if (lowest < 0) return;
    if (!(porosity(lowest) > 0.0)) report_porosity(soil, lowest);
    if (!(porosity(highest) <= soil.porosity_max() + porosity_round_off)) {
      report_porosity(soil, highest);
    }
    const double least = soil.deposition.porosity_min;
    if (!soil.deposition.has_room_limit() || porosity(lowest) > least) return;
    report("soil." + soil.region + ".deposition.porosity_min",
           "n_min = " + short_number(least) + " with n_0 = " + short_number(porosity(lowest)) +
               " at " + place_text<Dim>(mesh_.nodes[lowest]),
           "n_min < n_0 everywhere in the region");
  }

  void report_porosity(const Soil& soil, int node) {
    const Vector<Dim>& x = mesh_.nodes[node];
    report(
        "soil." + soil.region + ".porosity_gradient",
        "n_0 = " + short_number(soil.initial_porosity(x)) + " at " + place_text<Dim>(x),
        "0 < n_0 <= 1 - n_C = " + short_number(soil.porosity_max()) + " everywhere in the region");
  }

  void check_boundaries() {
    // Faces with a condition, with the name of their boundary.
    std::map<std::array<int, Dim>, std::string> covered;
    for (const BoundaryCondition& condition : document_.scene.boundaries) {
      const std::string key = condition.key + ".on";
      const bool fits = condition.is_well()
                            ? check_inner(key, condition.on, "a curve or a point", inner_)
                            : check_outer(key, condition.on);
      const auto set = std::ranges::find(mesh_.boundaries, condition.on, &BoundarySet<Dim>::name);
      if (fits && set != mesh_.boundaries.end()) cover(covered, key, *set);
    }
  }

  bool check_outer(const std::string& key, const std::string& name) {
    if (std::ranges::find(outer_, name) != outer_.end()) return true;
    const bool inside = std::ranges::find(inner_, name) != inner_.end();
    report(key, in_quotes(name) + (inside ? ", which lies inside the mesh" : ""),
           "a boundary of the mesh: " + quoted_list(outer_) +
               (inside ? "; what lies inside is for [[wall]] and [[well]]" : ""),
           inside ? "" : suggest(name, outer_));
    return false;
  }

  /// Whether a name is inside the mesh. Names that are inside but not cut are reported elsewhere.
  bool check_inner(const std::string& key, const std::string& name, const std::string& what,
                   const std::vector<std::string>& names) {
    if (std::ranges::find(inner_, name) != inner_.end()) return true;
    const bool outer = std::ranges::find(outer_, name) != outer_.end();
    report(key, in_quotes(name) + (outer ? ", an outer boundary" : ""),
           what + " inside the mesh" +
               (names.empty() ? "; there is none with a name" : ": " + quoted_list(names)),
           outer ? "" : suggest(name, names));
    return false;
  }

  void check_walls() {
    for (std::size_t i = 0; i < document_.scene.walls.size(); ++i) {
      check_inner("wall[" + std::to_string(i) + "].on", document_.scene.walls[i].on, "a curve",
                  curves_);
    }
  }

  /// Steady flow under gravity stands at no certain level in a piece of the mesh that walls cut off
  /// from every boundary that sets one.
  void check_levels() {
    const Scene& scene = document_.scene;
    if (scene.initial_flow != InitialFlow::steady || !has_gravity(scene.gravity)) return;
    const std::vector<int> pieces = mesh_pieces<Dim>(mesh_, sides_of_conducting_walls());
    std::set<int> with_level;
    for (const BoundaryCondition& condition : scene.boundaries) {
      if (!sets_level(condition)) continue;
      const auto set = std::ranges::find(mesh_.boundaries, condition.on, &BoundarySet<Dim>::name);
      if (set == mesh_.boundaries.end()) return;  // reported already
      for (const auto& face : set->faces) with_level.insert(pieces[face.front()]);
    }
    if (with_level.empty()) return;  // refused without a mesh
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const std::string& region = mesh_.region_names[mesh_.element_region[e]];
      const bool has_water = scene.find_soil(region) != nullptr || scene.is_free_water(region);
      if (!has_water || with_level.contains(pieces[mesh_.elements[e].front()])) continue;
      report(
          "initial.flow",
          "\"steady\" where nothing sets the level of the water in the part of the mesh around " +
              place_text<Dim>(element_centroid(mesh_, e)),
          "a boundary with a head, pressure, seepage_face or rain, or a well with a head or "
          "seepage_face, in each part that walls cut off, a wall with a conductance, or flow = "
          "\"rest\" with initial.water_level");
      return;
    }
  }

  [[nodiscard]] std::vector<FacePair<Dim>> sides_of_conducting_walls() const {
    std::vector<FacePair<Dim>> sides;
    for (const Wall& wall : document_.scene.walls) {
      const auto set = std::ranges::find(mesh_.boundaries, wall.on, &BoundarySet<Dim>::name);
      if (!(wall.conductance > 0.0) || set == mesh_.boundaries.end()) continue;
      for (std::size_t i = 0; i + 1 < set->faces.size(); i += 2) {
        sides.push_back({set->faces[i], set->faces[i + 1]});
      }
    }
    return sides;
  }

  /// Refuses heads that pass a face, which changes the kind of its condition: the explicit scheme
  /// cannot do that.
  void check_explicit_heads() {
    const Scene& scene = document_.scene;
    if (scene.time.scheme != FlowScheme::explicit_nodal || !has_gravity(scene.gravity)) return;
    for (const BoundaryCondition& condition : scene.boundaries) {
      if (!condition.head || condition.dry == DryPart::suction) continue;
      const auto set = std::ranges::find(mesh_.boundaries, condition.on, &BoundarySet<Dim>::name);
      if (set == mesh_.boundaries.end()) continue;
      double top = -std::numeric_limits<double>::infinity();
      const double lowest = condition.head->range(0.0, scene.time.end).first;
      const WaterLine<Dim> water_line(mesh_, scene.gravity, largest_coordinate(mesh_));
      bool is_covered = true;
      for (const auto& face : set->faces) {
        top = std::max(top, water_line.centre_height(face));
        is_covered = is_covered && lowest > water_line.wet_above(face);
      }
      if (is_covered) continue;
      const bool from_file = !document_.where.contains(condition.key + ".head");
      report(condition.key + (from_file ? ".file" : ".head"),
             "a head of " + short_number(lowest) + " m with scheme = \"explicit\"",
             "a head above " + short_number(top) + " m, the highest face of " +
                 in_quotes(condition.on) +
                 ", at all times, or scheme = \"implicit\": what is above the water changes there");
    }
  }

  void check_outputs() {
    const OutputSettings& output = document_.scene.output;
    for (std::size_t i = 0; i < output.probes.size(); ++i) {
      const std::string key = "output.probe[" + std::to_string(i) + "].at";
      check_two_dimensional(key, output.probes[i].at);
      const Vector<Dim> x = position(output.probes[i].at);
      if (!lies_in_mesh(x)) report(key, place_text<Dim>(x), "a point of the mesh" + box());
    }
    for (std::size_t i = 0; i < output.sections.size(); ++i) {
      const std::string entry = "output.section[" + std::to_string(i) + "]";
      const OutputSection& section = output.sections[i];
      check_two_dimensional(entry + ".from", section.from);
      check_two_dimensional(entry + ".to", section.to);
      if constexpr (Dim == 2) {
        if (section.from == section.to || crosses_mesh(section)) continue;
        report(entry,
               "a line from " + place_text<Dim>(position(section.from)) + " to " +
                   place_text<Dim>(position(section.to)),
               "a line that meets the mesh" + box());
      }
    }
  }

  [[nodiscard]] static Vector<Dim> position(const std::array<double, 3>& x) {
    Vector<Dim> result;
    for (int d = 0; d < Dim; ++d) result[d] = x[d];
    return result;
  }

  [[nodiscard]] std::string box() const {
    Vector<Dim> low = mesh_.nodes.front();
    Vector<Dim> high = low;
    for (const Vector<Dim>& x : mesh_.nodes) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    return ", which lies between " + place_text<Dim>(low) + " and " + place_text<Dim>(high);
  }

  [[nodiscard]] bool lies_in_mesh(const Vector<Dim>& x) const {
    for (int e = 0; e < mesh_.element_count(); ++e) {
      if (std::ranges::min(barycentric(mesh_, e, x)) >= -on_the_edge) return true;
    }
    return false;
  }

  /// Whether a part of the line lies in some element; each element clips the line at its edges.
  [[nodiscard]] bool crosses_mesh(const OutputSection& section) const {
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const auto from = barycentric(mesh_, e, position(section.from));
      const auto to = barycentric(mesh_, e, position(section.to));
      double first = 0.0;
      double last = 1.0;
      for (int k = 0; k <= Dim; ++k) {  // keep the part with from + s change >= 0
        const double change = to[k] - from[k];
        if (change > 0.0) first = std::max(first, -from[k] / change);
        if (change < 0.0) last = std::min(last, -from[k] / change);
        if (change == 0.0 && from[k] < 0.0) last = -1.0;
      }
      if (first < last) return true;
    }
    return false;
  }

  void cover(std::map<std::array<int, Dim>, std::string>& covered, const std::string& key,
             const BoundarySet<Dim>& set) {
    for (const auto& face : set.faces) {
      const auto [entry, is_new] = covered.emplace(face_key<Dim>(face), set.name);
      if (is_new) continue;
      report(key, in_quotes(set.name),
             "a boundary that shares no face with " + in_quotes(entry->second) +
                 "; both have the one at " + place_text<Dim>(centre(face)));
      return;
    }
  }

  [[nodiscard]] Vector<Dim> centre(const std::array<int, Dim>& face) const {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (const int node : face) sum += mesh_.nodes[node] / Dim;
    return sum;
  }

  const SceneDocument& document_;
  const Mesh<Dim>& mesh_;
  std::vector<std::string> curves_;  ///< inside the mesh, cut or not
  std::vector<std::string> inner_;   ///< `curves_` and points inside the mesh
  std::vector<std::string> outer_;   ///< boundaries
  std::vector<std::string> slit_;    ///< curves and points that are cut
  std::set<std::string> meant_;      ///< regions that misspelt names of soils most likely mean
  std::vector<InputProblem> problems_;
};

}  // namespace

template <int Dim>
std::vector<InputProblem> scene_problems(const SceneDocument& document, const Mesh<Dim>& mesh,
                                         const InnerNames& inner) {
  return SceneCheck<Dim>(document, mesh, inner).run();
}

template std::vector<InputProblem> scene_problems<2>(const SceneDocument&, const Mesh<2>&,
                                                     const InnerNames&);
template std::vector<InputProblem> scene_problems<3>(const SceneDocument&, const Mesh<3>&,
                                                     const InnerNames&);

}  // namespace suffuse

#include "case/consistency.hpp"

#include <algorithm>
#include <map>

#include "case/closest_name.hpp"
#include "case/faces.hpp"
#include "case/short_number.hpp"

namespace suffuse {

namespace {

/// Round-off of n_0 + gradient . (x - origin), so that a gradient may end exactly on a bound.
constexpr double porosity_round_off = 1e-12;

std::string in_quotes(const std::string& name) {
  return '"' + name + '"';
}

template <int Dim>
std::string place(const Vector<Dim>& x) {
  std::string text = "(" + short_number(x[0]);
  for (int d = 1; d < Dim; ++d) text += ", " + short_number(x[d]);
  return text + ")";
}

template <int Dim>
class SceneCheck {
 public:
  SceneCheck(const SceneDocument& document, const Mesh<Dim>& mesh)
      : document_(document), mesh_(mesh) {}

  std::vector<InputProblem> run() {
    check_directions();
    check_soils();
    check_regions();
    check_boundaries();
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

  /// A third component, gravity's for one, would silently be dropped in two dimensions.
  void check_two_dimensional(const std::string& key, const std::array<double, 3>& value) {
    if (Dim == 2 && value[2] != 0.0) {
      report(key, "a third number, " + short_number(value[2]),
             "two numbers: the mesh is two-dimensional");
    }
  }

  void check_directions() {
    check_two_dimensional("gravity", document_.scene.gravity);
    for (const Soil& soil : document_.scene.soils) {
      check_two_dimensional("soil." + soil.region + ".porosity_gradient", soil.porosity_gradient);
      check_two_dimensional("soil." + soil.region + ".porosity_origin", soil.porosity_origin);
    }
  }

  void check_soils() {
    for (const Soil& soil : document_.scene.soils) {
      const auto region = std::ranges::find(mesh_.region_names, soil.region);
      if (region == mesh_.region_names.end()) {
        report("soil." + soil.region, in_quotes(soil.region),
               "a region of the mesh: " + quoted_list(mesh_.region_names),
               suggest(soil.region, mesh_.region_names));
      } else {
        check_porosity(soil, static_cast<int>(region - mesh_.region_names.begin()));
      }
    }
  }

  void check_regions() {
    std::vector<std::string> soils;
    for (const Soil& soil : document_.scene.soils) soils.push_back(soil.region);
    for (const std::string& region : mesh_.region_names) {
      const Scene& scene = document_.scene;
      if (scene.find_soil(region) != nullptr || scene.is_free_water(region)) continue;
      std::string expected = "a table [soil." + region + "] for the mesh's region of that name";
      if (names_free_water(region)) {
        expected += ", or formulation = \"double-point\", where it is free water without one";
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
  }

  void report_porosity(const Soil& soil, int node) {
    const Vector<Dim>& x = mesh_.nodes[node];
    report(
        "soil." + soil.region + ".porosity_gradient",
        "n_0 = " + short_number(soil.initial_porosity(x)) + " at " + place<Dim>(x),
        "0 < n_0 <= 1 - n_C = " + short_number(soil.porosity_max()) + " everywhere in the region");
  }

  void check_boundaries() {
    std::vector<std::string> names;
    for (const auto& set : mesh_.boundaries) names.push_back(set.name);
    const auto& conditions = document_.scene.boundaries;
    std::map<std::array<int, Dim>, std::string> covered;  // by the condition of that name
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      const std::string key = conditions[i].key + ".on";
      const auto found = std::ranges::find(names, conditions[i].on);
      if (found == names.end()) {
        report(key, in_quotes(conditions[i].on), "a boundary of the mesh: " + quoted_list(names),
               suggest(conditions[i].on, names));
      } else {
        cover(covered, key, mesh_.boundaries[static_cast<std::size_t>(found - names.begin())]);
      }
    }
  }

  void cover(std::map<std::array<int, Dim>, std::string>& covered, const std::string& key,
             const BoundarySet<Dim>& set) {
    for (const auto& face : set.faces) {
      const auto [entry, is_new] = covered.emplace(face_key<Dim>(face), set.name);
      if (is_new) continue;
      Vector<Dim> centre = Vector<Dim>::Zero();
      for (int node : face) centre += mesh_.nodes[node] / Dim;
      report(key, in_quotes(set.name),
             "a boundary that shares no face with " + in_quotes(entry->second) +
                 "; both have the one at " + place<Dim>(centre));
      return;
    }
  }

  const SceneDocument& document_;
  const Mesh<Dim>& mesh_;
  std::vector<InputProblem> problems_;
};

}  // namespace

template <int Dim>
std::vector<InputProblem> scene_problems(const SceneDocument& document, const Mesh<Dim>& mesh) {
  return SceneCheck<Dim>(document, mesh).run();
}

template std::vector<InputProblem> scene_problems<2>(const SceneDocument&, const Mesh<2>&);
template std::vector<InputProblem> scene_problems<3>(const SceneDocument&, const Mesh<3>&);

}  // namespace suffuse

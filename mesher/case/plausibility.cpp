#include "case/plausibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "case/plausibility_base.hpp"
#include "common/short_number.hpp"
#include "mesh/place_text.hpp"
#include "physics/skeleton/skeleton_law.hpp"
#include "scene/geometry_checks.hpp"

namespace suffuse {
namespace {

// Limits within which there is no warning.
constexpr double shortest_model = 1e-3;        // m
constexpr double longest_model = 1e4;          // m
constexpr double longest_without_scale = 1e3;  // m, of a file with an unknown unit
constexpr double lightest_water = 500.0;       // kg/m3
constexpr double heaviest_water = 2000.0;      // kg/m3
constexpr double thinnest_water = 1e-4;        // Pa s
constexpr double thickest_water = 0.1;         // Pa s
constexpr double softest_water = 1e4;          // Pa
constexpr double weakest_gravity = 1.6;        // m/s2, that of the moon
constexpr double strongest_gravity = 5e3;      // m/s2, of a centrifuge
constexpr double lightest_grains = 1500.0;     // kg/m3
constexpr double fastest_soil = 1.0;           // m/s
/// m of water: fine sand drains at higher suctions.
constexpr double unnoticed_suction = 0.5;
/// Least number of elements along an `erosion.length`, and along a `field.correlation`.
constexpr double elements_of_length = 2.0;

constexpr double infinite = std::numeric_limits<double>::infinity();

template <int Dim>
class Plausibility : private PlausibilityBase<Dim> {
 public:
  using PlausibilityBase<Dim>::PlausibilityBase;

  std::vector<std::string> unusual() {
    check_lengths();
    check_water();
    for (const Soil& soil : scene_.soils) check_soil(soil);
    check_gravity();
    check_resolution();
    check_erosion_lengths();
    check_lengths_of_fields();
    return std::move(warnings_);
  }

  std::vector<std::string> suction() {
    if (!has_gravity(scene_.gravity)) return {};
    for (std::size_t r = 0; r < mesh_.region_names.size(); ++r) {
      const Soil* soil = scene_.find_soil(mesh_.region_names[r]);
      if (soil && !soil->drains()) check_suction(*soil, static_cast<int>(r));
    }
    return std::move(warnings_);
  }

 private:
  using Base = PlausibilityBase<Dim>;
  using Base::as_head;
  using Base::given;
  using Base::mesh_;
  using Base::scene_;
  using Base::table_of;
  using Base::warn;
  using Base::warnings_;
  using Base::z;

  void check_lengths() {
    const Vector<Dim> sides = extent(mesh_);
    const double longest = sides.maxCoeff();
    const bool from_file = !scene_.geometry.file.empty();
    const bool unit_unknown = from_file && !given("geometry.scale") && !states_unit();
    const bool too_long = longest > (unit_unknown ? longest_without_scale : longest_model);
    if (!too_long && longest >= shortest_model) return;
    std::string text = "the model is " + short_number(sides[0]);
    for (int d = 1; d < Dim; ++d) text += " x " + short_number(sides[d]);
    text += " m; 1 mm to 1 km are usual";
    if (unit_unknown && too_long) {
      text +=
          ". Where the file is in millimetres, give geometry.scale = 0.001; where it is in "
          "metres, geometry.scale = 1";
    } else if (from_file) {
      text += states_unit() ? ": is the unit that the STEP file states the right one?"
                            : ": geometry.scale is the length of a unit of the file, in m";
    }
    warn(from_file            ? "geometry.file"
         : sides[1] < longest ? "geometry.width"
                              : "geometry.height",
         text);
  }

  /// Whether the geometry file states its unit of length: .step files do, and are read in metres.
  [[nodiscard]] bool states_unit() const { return is_step_file(scene_.geometry.file); }

  /// Warns of a value that is not between two usual ones, all of a unit.
  void check_range(const std::string& key, double value, double low, double high,
                   const std::string& unit, const std::string& example) {
    if (value >= low && value <= high) return;
    warn(key, short_number(value) + " " + unit + "; " + short_number(low) +
                  (std::isinf(high) ? " and more" : " to " + short_number(high)) + " are usual, " +
                  example);
  }

  void check_water() {
    const LiquidProperties& water = scene_.liquid;
    check_range("liquid.density", water.density, lightest_water, heaviest_water, "kg/m3",
                "water has 1000");
    check_range("liquid.viscosity", water.viscosity, thinnest_water, thickest_water, "Pa s",
                "water has 0.001");
    check_range("liquid.bulk_modulus", water.bulk_modulus, softest_water, infinite, "Pa",
                "water has 2e9");
  }

  void check_soil(const Soil& soil) {
    check_range(joined(table_of(soil), "grain_density"), soil.grain_density, lightest_grains,
                infinite, "kg/m3", "quartz has 2650");
    const double across =
        std::isnan(soil.conductivity_across) ? soil.conductivity : soil.conductivity_across;
    const double fastest = std::max(soil.conductivity, across);
    if (fastest > fastest_soil) {
      warn(joined(table_of(soil), "conductivity"), short_number(fastest) + " m/s; at most " +
                                                       short_number(fastest_soil) +
                                                       " is usual, coarse gravel has some 0.1");
    }
  }

  void check_gravity() {
    if (has_gravity(scene_.gravity)) {
      check_range("gravity", std::hypot(scene_.gravity[0], scene_.gravity[1], scene_.gravity[2]),
                  weakest_gravity, strongest_gravity, "m/s2", "the earth has 9.81");
    }
    if (!(scene_.gravity[Dim - 1] > 0.0)) return;
    std::vector<double> g(scene_.gravity.begin(), scene_.gravity.begin() + Dim);
    std::string text = shown_value(g) + " points upwards, along +" + (Dim == 2 ? "y" : "z");
    g.assign(Dim, 0.0);
    g.back() = -9.81;
    warn("gravity", text + "; " + shown_value(g) + " is usual");
  }

  // Elements across a region.

  /// Number of edges from each node to the nearest place where liquid may enter or leave its
  /// region: 0, 1, or 2 for larger distances. Impervious sides are no such places: they may be
  /// planes of symmetry, with flow on both sides.
  [[nodiscard]] std::vector<int> edges_from_flow() const {
    constexpr int far = 2;
    std::vector<int> edges(mesh_.nodes.size(), far);
    std::vector<int> region(mesh_.nodes.size(), -1);
    for (int e = 0; e < mesh_.element_count(); ++e) {
      for (const int node : mesh_.elements[e]) {
        if (region[node] < 0) region[node] = mesh_.element_region[e];
        if (region[node] != mesh_.element_region[e]) edges[node] = 0;
      }
    }
    for (const BoundaryCondition& condition : scene_.boundaries) {
      const BoundarySet<Dim>* set = find_boundary(condition.on);
      if (!set || condition.is_impervious()) continue;
      for (const auto& face : set->faces) {
        for (const int node : face) edges[node] = 0;
      }
    }
    for (const auto& corners : mesh_.elements) {
      if (std::ranges::none_of(corners, [&](int node) { return edges[node] == 0; })) continue;
      for (const int node : corners) edges[node] = std::min(edges[node], 1);
    }
    return edges;
  }

  /// Whether a region is a layer of a column: the scene gives its number of rows.
  [[nodiscard]] bool is_layer(const std::string& region) const {
    return !scene_.geometry.shape.empty() && region == "buffer";
  }

  /// Mean edge of the elements of a region, m, as if they were regular.
  [[nodiscard]] double element_size(const std::string& region) const {
    double volume = 0.0;
    int count = 0;
    for (int e = 0; e < mesh_.element_count(); ++e) {
      if (mesh_.region_names[mesh_.element_region[e]] != region) continue;
      volume += element_volume(mesh_, e);
      ++count;
    }
    return count == 0 ? 0.0 : regular_edge<Dim>(volume / count);
  }

  /// Warns of a length, m, that the elements of a soil do not resolve.
  void check_length(const Soil& soil, const std::string& key, double length,
                    const std::string& consequence) {
    const double size = element_size(soil.region);
    if (length >= elements_of_length * size) return;
    warn(joined(table_of(soil), key), short_number(length) + " m is shorter than two elements of " +
                                          short_number(size) + " m, so that " + consequence);
  }

  void check_lengths_of_fields() {
    for (const Soil& soil : scene_.soils) {
      if (!soil.field.varies()) continue;
      check_length(soil, "field.correlation", std::min(soil.field.along, soil.field.across),
                   "the mesh decides how the conductivity varies; three elements and more are "
                   "usual");
    }
  }

  void check_erosion_lengths() {
    for (const Soil& soil : scene_.soils) {
      const double length = soil.erosion.length;
      if (length == 0.0 || !depends_on_flux(soil.erosion_model())) continue;
      check_length(soil, "erosion.length", length, "channels are as wide as the mesh lets them be");
    }
  }

  void check_resolution() {
    if (scene_.mesh.error) return;  // that decides how fine the mesh becomes
    const std::vector<int> edges = edges_from_flow();
    std::vector<bool> resolved(mesh_.region_names.size(), false);
    for (int e = 0; e < mesh_.element_count(); ++e) {
      // Two edges to either side make four elements.
      const auto is_far = [&](int node) { return edges[node] > 1; };
      if (std::ranges::any_of(mesh_.elements[e], is_far)) resolved[mesh_.element_region[e]] = true;
    }
    const bool sized = given("mesh.size");
    const double side = extent(mesh_).minCoeff();
    if (sized && !scene_.geometry.file.empty() && scene_.mesh.size > side) {
      warn("mesh.size", short_number(scene_.mesh.size) +
                            " m is more than the shortest side of the model, " +
                            short_number(side) + " m; at most a quarter of it is usual");
      return;
    }
    const std::string found =
        sized ? short_number(scene_.mesh.size) + " m leaves" : std::string("the mesh has");
    for (std::size_t r = 0; r < resolved.size(); ++r) {
      const std::string& name = mesh_.region_names[r];
      if (resolved[r] || !scene_.find_soil(name) || is_layer(name)) continue;
      warn(sized ? "mesh.size" : "geometry",
           found + " fewer than 4 elements across the region " + shown_value(name) +
               ", from where water enters it to where it leaves; 4 or more are usual");
    }
  }

  // Suction in soil that stays full of water.

  /// The highest suction found, m of water, its place and its cause.
  struct Suction {
    double height = unnoticed_suction;
    Vector<Dim> at;
    std::string cause;
  };

  [[nodiscard]] const BoundarySet<Dim>* find_boundary(const std::string& name) const {
    const auto set = std::ranges::find(mesh_.boundaries, name, &BoundarySet<Dim>::name);
    return set == mesh_.boundaries.end() ? nullptr : &*set;
  }

  /// The highest prescribed head, which no head exceeds once the flow is steady; nothing if a
  /// prescribed flux lets liquid in, or if no head is prescribed.
  [[nodiscard]] std::optional<double> highest_head() const {
    double highest = -infinite;
    for (const BoundaryCondition& b : scene_.boundaries) {
      for (const auto& flux : {b.velocity, b.darcy_flux, b.rain, b.rate}) {
        if (flux && flux->largest() > 0.0) return std::nullopt;
      }
      if (b.head) highest = std::max(highest, b.head->range(0.0, scene_.time.end).second);
      const BoundarySet<Dim>* set = find_boundary(b.on);
      if (!b.pressure || !set) continue;
      const double head = as_head(b.pressure->range(0.0, scene_.time.end).second);
      for (const auto& face : set->faces) {
        for (const int node : face) highest = std::max(highest, z(node) + head);
      }
    }
    return std::isfinite(highest) ? std::optional(highest) : std::nullopt;
  }

  void check_suction(const Soil& soil, int region) {
    std::vector<bool> in_region(mesh_.nodes.size(), false);
    int top = -1;
    for (int e = 0; e < mesh_.element_count(); ++e) {
      if (mesh_.element_region[e] != region) continue;
      for (const int node : mesh_.elements[e]) {
        in_region[node] = true;
        if (top < 0 || z(node) > z(top)) top = node;
      }
    }
    if (top < 0) return;
    Suction worst;
    const auto raise = [&](double suction, int node, const std::string& cause) {
      if (suction > worst.height) worst = {suction, mesh_.nodes[node], cause};
    };
    const bool at_rest = scene_.initial_flow == InitialFlow::rest && scene_.initial_from.empty();
    if (at_rest && scene_.water_level) {
      raise(z(top) - *scene_.water_level, top,
            "the water level at the start is " + short_number(*scene_.water_level) + " m");
    }
    if (const auto head = highest_head()) {
      raise(z(top) - *head, top,
            "no boundary prescribes a head above " + short_number(*head) + " m");
    }
    for (const BoundaryCondition& b : scene_.boundaries) {
      const BoundarySet<Dim>* set = find_boundary(b.on);
      if (!set) continue;
      for (const auto& face : set->faces) {
        const auto inside = [&](int node) { return in_region[node]; };
        if (std::ranges::all_of(face, inside)) raise_at_face(b, face, raise);
      }
    }
    if (!worst.cause.empty()) warn_of_suction(soil, worst);
  }

  /// Raises the suction to that which a boundary prescribes at a face.
  template <class Raise>
  void raise_at_face(const BoundaryCondition& b, const std::array<int, Dim>& face,
                     const Raise& raise) const {
    for (const int node : face) {
      if (b.head && b.dry == DryPart::suction) {
        const double lowest = b.head->range(0.0, scene_.time.end).first;
        raise(z(node) - lowest, node,
              b.key + " prescribes the suction of a head of " + short_number(lowest) + " m");
      }
      if (b.pressure) {
        const double lowest = b.pressure->range(0.0, scene_.time.end).first;
        raise(-as_head(lowest), node, b.key + " prescribes " + short_number(lowest) + " Pa");
      }
    }
  }

  void warn_of_suction(const Soil& soil, const Suction& worst) {
    warn(joined(table_of(soil), "retention"),
         "none, and a suction of " + short_number(worst.height) + " m of water at " +
             place_text<Dim>(worst.at) + ": " + worst.cause +
             ". Without a retention law the soil stays full of water there" +
             (this->has_free_water() ? ", as do regions without soil, whose water loads it" : "") +
             "; real soil drains, and conducts less. Up to " + short_number(unnoticed_suction) +
             " m are usual");
  }
};

}  // namespace

template <int Dim>
std::vector<std::string> plausibility_warnings(const SceneDocument& document,
                                               const Mesh<Dim>& mesh) {
  std::vector<std::string> warnings = Plausibility<Dim>(document, mesh).unusual();
  for (const auto& part : {time_warnings<Dim>, flow_warnings<Dim>, soil_warnings<Dim>,
                           load_warnings<Dim>, idle_key_warnings<Dim>}) {
    const std::vector<std::string> more = part(document, mesh);
    warnings.insert(warnings.end(), more.begin(), more.end());
  }
  return warnings;
}

template <int Dim>
std::vector<std::string> suction_warnings(const SceneDocument& document, const Mesh<Dim>& mesh) {
  return Plausibility<Dim>(document, mesh).suction();
}

template std::vector<std::string> plausibility_warnings(const SceneDocument&, const Mesh<2>&);
template std::vector<std::string> plausibility_warnings(const SceneDocument&, const Mesh<3>&);
template std::vector<std::string> suction_warnings(const SceneDocument&, const Mesh<2>&);
template std::vector<std::string> suction_warnings(const SceneDocument&, const Mesh<3>&);

}  // namespace suffuse

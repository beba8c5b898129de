#include "checks/section_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "checks/blanket_theory.hpp"
#include "checks/sellmeijer.hpp"
#include "checks/vertical_lines.hpp"
#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "mesh/faces.hpp"
#include "physics/head.hpp"
#include "values/derived_fields.hpp"

namespace suffuse {
namespace {

[[noreturn]] void refuse_setting(const ResultsReader& results, const std::string& key,
                                 const std::string& found, const std::string& expected) {
  throw InputError(InputProblem{results.scene().locate(key), key, found, expected});
}

/// Refuses gravity that is not along y: lengths are taken along x. `more`: what else is allowed, or
/// why.
void expect_gravity_along_y(const ResultsReader& results, const std::string& more) {
  constexpr double round_off = 1e-9;
  const Scene& scene = results.scene().scene;
  if (std::abs(upward<2>(scene)[0]) <= round_off) return;
  refuse_setting(
      results, "gravity",
      "[" + short_text(scene.gravity[0]) + ", " + short_text(scene.gravity[1]) + "] m/s2",
      "gravity along y, " + more);
}

/// Mesh and vertical lines of a plane section.
class Section {
 public:
  Section(const ResultsReader& results, const std::string& table)
      : results_(results),
        mesh_(plane_mesh(results, table)),
        lines_(mesh_, results.scene().scene) {}

  [[nodiscard]] const Mesh<2>& mesh() const { return mesh_; }
  [[nodiscard]] const VerticalLines<2>& lines() const { return lines_; }

  /// The line below the ground at x. Throws InputError, naming the key that gave x.
  [[nodiscard]] std::vector<LineSegment<2>> below(double x, const std::string& key) const {
    return lines_.below(ground_at(x, key));
  }
  [[nodiscard]] GroundPlace<2> ground_at(double x, const std::string& key,
                                         double side = 0.0) const {
    const auto place = lines_.ground_at(x, side);
    if (!place)
      refuse_setting(results_, key, short_text(x) + " m", "an x with ground of the model");
    return *place;
  }

  /// Nodes of a boundary; of one region, if it is given.
  [[nodiscard]] std::vector<int> nodes_of(const std::string& boundary,
                                          const std::string& region = {}) const {
    std::vector<int> nodes;
    const auto set = std::ranges::find(mesh_.boundaries, boundary, &BoundarySet<2>::name);
    if (set == mesh_.boundaries.end()) return nodes;
    for (int e = 0; e < mesh_.element_count(); ++e) {
      if (!region.empty() && lines_.region_of(e) != region) continue;
      for (int a = 0; a <= 2; ++a) {
        const auto face = face_opposite<2>(mesh_.elements[e], a);
        const auto is_face = [&](const std::array<int, 2>& other) {
          return face_key<2>(other) == face_key<2>(face);
        };
        if (std::ranges::any_of(set->faces, is_face))
          nodes.insert(nodes.end(), face.begin(), face.end());
      }
    }
    return nodes;
  }

 private:
  static Mesh<2> plane_mesh(const ResultsReader& results, const std::string& table) {
    if (results.dimension() == 3) {
      refuse_setting(results, table, "a check of plane sections in three dimensions",
                     "no such table");
    }
    return results.mesh<2>();
  }

  const ResultsReader& results_;
  Mesh<2> mesh_;
  VerticalLines<2> lines_;
};

/// A difference of head over the cover's thickness that is none.
constexpr double negligible_head = 1e-6;

/// The path of a pipe through a layer, level along x.
struct PipePath {
  double from;  ///< x of the entry, m
  double to;    ///< x of the exit, m
  [[nodiscard]] double length() const { return std::abs(to - from); }
};

PipePath path_in_drawing(const ResultsReader& results, const Section& section,
                         const BackwardErosionSettings& settings) {
  const auto nodes_at = [&](const std::string& boundary) {
    std::vector<int> nodes = section.nodes_of(boundary, settings.layer);
    if (nodes.empty()) {
      refuse_setting(results, "check.backward_erosion.length",
                     "nothing, and the boundary \"" + boundary + "\" has no face of the layer \"" +
                         settings.layer + "\"",
                     "the length of the seepage path, and the thickness of the layer, in m");
    }
    return nodes;
  };
  const std::vector<int> entry = nodes_at(settings.entry);
  const std::vector<int> exit = nodes_at(settings.exit);
  PipePath shortest{0.0, std::numeric_limits<double>::infinity()};
  for (const int i : entry) {
    for (const int j : exit) {
      const PipePath path{section.mesh().nodes[i][0], section.mesh().nodes[j][0]};
      if (path.length() < shortest.length()) shortest = path;
    }
  }
  if (!(shortest.length() > 0.0)) {
    refuse_setting(results, "check.backward_erosion.length",
                   "nothing, and entry and exit of the layer one above the other",
                   "the length of the seepage path, in m");
  }
  return shortest;
}

double mean_thickness(const Section& section, const PipePath& path, const std::string& layer) {
  constexpr int count = 20;
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const double x = path.from + (i + 0.5) / count * (path.to - path.from);
    const auto line = section.below(x, "check.backward_erosion.thickness");
    sum += length_of<2>(section.lines().highest_layer(line, layer));
  }
  return sum / count;
}

/// Heads at the nodes of a boundary, m. Dry ground counts with its height: water leaves there at
/// p = 0.
double largest_head(const Section& section, const std::vector<double>& head,
                    const std::string& boundary) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const int i : section.nodes_of(boundary)) largest = std::max(largest, head[i]);
  return largest;
}
double smallest_head(const ResultsReader& results, const Section& section,
                     const std::vector<double>& head, const std::string& boundary) {
  const auto& gravity = results.scene().scene.gravity;
  double smallest = std::numeric_limits<double>::infinity();
  for (const int i : section.nodes_of(boundary)) {
    const double level = has_gravity(gravity)
                             ? std::max(head[i], height(section.mesh().nodes[i], gravity))
                             : head[i];
    smallest = std::min(smallest, level);
  }
  return smallest;
}

/// Conductivity of a layer that water flows along, between soils that conduct less, m/s: the flux
/// is level, also where bedding is oblique.
double conductivity_along_layer(const Scene& scene, const Soil& soil) {
  const Vector<2> up = upward<2>(scene);
  return soil.conductivity / soil.resistance_along(Vector<2>(up[1], -up[0]));
}

/// Conductivity of a cover that water flows across, m/s: the gradient is upright.
double conductivity_across_layer(const Scene& scene, const Soil& soil) {
  const double angle = soil.bedding * std::numbers::pi / 180.0;
  const double cosine = upward<2>(scene).dot(Vector<2>(-std::sin(angle), std::cos(angle)));
  return soil.conductivity * (1.0 + (soil.anisotropy() - 1.0) * cosine * cosine);
}

PipingLayer piping_layer(const ResultsReader& results, const BackwardErosionSettings& settings) {
  const Scene& scene = results.scene().scene;
  const Soil& soil = *scene.find_soil(settings.layer);
  const auto size = [&](double percent) {
    return soil.gradation.empty() || percent < soil.gradation.smallest_finer()
               ? unset
               : soil.gradation.size(percent);
  };
  PipingLayer layer;
  layer.d70 = 1e-3 * (std::isnan(settings.d70) ? size(70.0) : settings.d70);
  const double graded = size(60.0) / size(10.0);
  if (!std::isnan(settings.uniformity)) {
    layer.uniformity = settings.uniformity;
  } else if (!std::isnan(graded)) {
    layer.uniformity = graded;
  }
  layer.permeability = conductivity_along_layer(scene, soil) * scene.liquid.viscosity /
                       (scene.liquid.density * conductivity_gravity);
  layer.relative_weight = soil.grain_density / scene.liquid.density - 1.0;
  layer.roundness = settings.roundness;
  layer.relative_density = settings.relative_density;
  layer.grain_size_correction = settings.grain_size_correction;
  return layer;
}

std::string sentences(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& sentence : list) text += "; " + sentence;
  return text;
}

/// The layers of blanket theory on a vertical line. Soils of their regions may come again in other
/// layers, which are no part of them.
struct BlanketLayers {
  LinePart<2> cover;  ///< the lowest one above the aquifer
  LinePart<2> aquifer;
};

BlanketLayers blanket_layers(const Section& section, LinePart<2> line,
                             const BlanketSettings& settings) {
  const LinePart<2> aquifer = section.lines().highest_layer(line, settings.aquifer);
  const LinePart<2> above{line.begin(), aquifer.begin()};
  return {section.lines().lowest_layer(above, settings.cover), aquifer};
}

/// A side of the levee beyond a toe.
BlanketSide side_of(const ResultsReader& results, const Section& section,
                    const BlanketSettings& settings, double toe, double away, AquiferEnd end,
                    const std::string& key) {
  const Scene& scene = results.scene().scene;
  BlanketSide side;
  side.end = end;
  for (int e = 0; e < section.mesh().element_count(); ++e) {
    if (section.lines().region_of(e) != settings.aquifer) continue;
    for (const int node : section.mesh().elements[e]) {
      side.length = std::max(side.length, away * (section.mesh().nodes[node][0] - toe));
    }
  }
  // The middle of the side: the slope of the levee ends at the toe itself.
  const double middle = toe + 0.5 * away * side.length;
  if (!(side.length > 0.0)) return side;
  const auto line = section.below(middle, key);
  side.cover_thickness = length_of<2>(blanket_layers(section, line, settings).cover);
  side.cover_conductivity = conductivity_across_layer(scene, *scene.find_soil(settings.cover));
  return side;
}

/// Refuses toes in the wrong order: the river stands on the riverside.
void expect_river_on_its_side(const ResultsReader& results, const Section& section,
                              const BlanketSettings& settings) {
  const std::vector<int> nodes = section.nodes_of(settings.entry);
  if (nodes.empty()) return;
  const auto x = [&](int node) { return section.mesh().nodes[node][0]; };
  const auto [first, last] = std::ranges::minmax(nodes, {}, x);
  const double entry = 0.5 * (x(first) + x(last));
  const double river_to_land = settings.landside_toe - settings.riverside_toe;
  const double middle = 0.5 * (settings.landside_toe + settings.riverside_toe);
  if ((entry - middle) * river_to_land < 0.0) return;
  refuse_setting(results, "check.blanket.landside_toe",
                 short_text(settings.landside_toe) + " m, with the middle of the boundary \"" +
                     settings.entry + "\" at x = " + short_text(entry) + " m",
                 "the toe that is further from \"" + settings.entry + "\" than riverside_toe, " +
                     short_text(settings.riverside_toe) + " m");
}

/// The section of the theory, by the layers below the landside toe. Throws InputError, naming the
/// toe.
BlanketSection blanket_section(const ResultsReader& results, const Section& section,
                               const BlanketSettings& settings, const BlanketLayers& layers) {
  const std::string table = "check.blanket";
  const std::string toe_key = table + ".landside_toe";
  const double towards_land = settings.landside_toe > settings.riverside_toe ? 1.0 : -1.0;
  BlanketSection blanket;
  blanket.base = std::abs(settings.landside_toe - settings.riverside_toe);
  blanket.aquifer_thickness = length_of<2>(layers.aquifer);
  const Scene& scene = results.scene().scene;
  blanket.aquifer_conductivity =
      conductivity_along_layer(scene, *scene.find_soil(settings.aquifer));
  blanket.riverside = side_of(results, section, settings, settings.riverside_toe, -towards_land,
                              settings.riverside, table + ".riverside_toe");
  blanket.landside = side_of(results, section, settings, settings.landside_toe, towards_land,
                             settings.landside, toe_key);
  if (!(blanket.aquifer_thickness > 0.0) || !blanket.landside.covered()) {
    refuse_setting(results, toe_key, short_text(settings.landside_toe) + " m",
                   "an x beyond which the aquifer \"" + settings.aquifer +
                       "\" lies below the cover \"" + settings.cover + "\"");
  }
  return blanket;
}

/// The highest heads at the landside toe in the snapshots, above the ground there or the water on
/// it, m.
struct ToeHeads {
  double time = unset;  ///< of the river
  double river = 0.0;
  double computed = 0.0;  ///< below the cover
};

std::string note_of(const ToeHeads& worst, double share) {
  if (!(worst.river > 0.0)) return "no river acts: its head is not above the ground at the toe";
  return "head below the cover at the toe: " + short_text(share * worst.river) +
         " m by blanket theory, " + short_text(worst.computed) + " m computed, of " +
         short_text(worst.river) + " m of the river";
}

}  // namespace

std::vector<CheckRow> backward_erosion_checks(const ResultsReader& results,
                                              const BackwardErosionSettings& settings) {
  if (settings.layer.empty()) return {};
  const Section section(results, "check.backward_erosion");
  PipingLayer layer = piping_layer(results, settings);
  layer.length = settings.length;
  layer.thickness = settings.thickness;
  if (std::isnan(layer.length) || std::isnan(layer.thickness)) {
    expect_gravity_along_y(results,
                           "or check.backward_erosion.length and thickness, which are "
                           "taken along x and y otherwise");
    const PipePath path = path_in_drawing(results, section, settings);
    if (std::isnan(layer.length)) layer.length = path.length();
    if (std::isnan(layer.thickness)) {
      layer.thickness = mean_thickness(section, path, settings.layer);
    }
  }
  CheckRow row{.mechanism = "backward-erosion",
               .where = settings.layer,
               .clause = "Sellmeijer and others (2011)"};
  row.effect = 0.0;
  row.resistance = critical_head(layer);
  row.unit = "m";
  for (std::size_t i = 0; i < results.times().size(); ++i) {
    const std::vector<double> head = any_field(results, i, "node", "head").values;
    const double difference = largest_head(section, head, settings.entry) -
                              smallest_head(results, section, head, settings.exit);
    if (!(difference > row.effect)) continue;
    row.effect = difference;
    row.time = results.times()[i];
    row.note_factor(row.resistance / row.effect, row.time);
  }
  if (row.effect > 0.0) row.factor = row.resistance / row.effect;
  row.note = "L = " + short_text(layer.length) + " m, D = " + short_text(layer.thickness) + " m" +
             sentences(outside_tests(layer));
  return {row};
}

std::vector<CheckRow> blanket_checks(const ResultsReader& results,
                                     const BlanketSettings& settings) {
  if (settings.aquifer.empty()) return {};
  const std::string table = "check.blanket";
  const Section section(results, table);
  const Scene& scene = results.scene().scene;
  const std::string toe_key = table + ".landside_toe";
  expect_gravity_along_y(results, "which check.blanket takes as upright");
  expect_river_on_its_side(results, section, settings);
  // The slope of the levee ends at the toe, and may carry no water where the land does.
  const double towards_land = settings.landside_toe > settings.riverside_toe ? 1.0 : -1.0;
  const GroundPlace<2> toe = section.ground_at(settings.landside_toe, toe_key, towards_land);
  const auto line = section.lines().below(toe);

  const BlanketLayers layers = blanket_layers(section, line, settings);
  const BlanketSection blanket = blanket_section(results, section, settings, layers);
  if (layers.cover.empty()) {
    refuse_setting(results, toe_key, "an aquifer without a cover", "a toe on the cover");
  }
  const double cover_at_toe = length_of<2>(layers.cover);
  const LineSegment<2>& above = *std::prev(layers.aquifer.begin());
  const LineSegment<2>& below = layers.aquifer.front();
  CheckRow row{.mechanism = "blanket", .where = settings.cover, .clause = "EM 1110-2-1913, B"};
  row.unit = "1";
  row.resistance = critical_gradient(results, results.times().size() - 1)[above.element];
  row.place = {settings.landside_toe, toe.position[1]};
  const double share = toe_share(blanket);
  ToeHeads worst;
  for (std::size_t i = 0; i < results.times().size(); ++i) {
    const std::vector<double> head = any_field(results, i, "node", "head").values;
    const auto at = [&](int element, const std::array<double, 3>& weights) {
      double sum = 0.0;
      for (int a = 0; a < 3; ++a) sum += weights[a] * head[section.mesh().elements[element][a]];
      return sum;
    };
    // Only water that stands on the ground raises the level at which water would leave.
    const double level = height(toe.position, scene.gravity);
    const double ground = toe.bears_water ? std::max(at(toe.element, toe.weights), level) : level;
    const double river = largest_head(section, head, settings.entry) - ground;
    if (river < negligible_head * cover_at_toe) continue;
    worst.computed = std::max(worst.computed, at(below.element, below.top_weights) - ground);
    if (!(river > worst.river)) continue;
    worst.time = results.times()[i];
    worst.river = river;
    row.note_factor(row.resistance / (share * river / cover_at_toe), worst.time);
  }
  row.time = worst.time;
  row.effect = share * worst.river / cover_at_toe;
  if (row.effect > 0.0) row.factor = row.resistance / row.effect;
  row.note = note_of(worst, share) + sentences(broken_assumptions(blanket));
  return {row};
}

}  // namespace suffuse

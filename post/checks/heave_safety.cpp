#include "checks/heave_safety.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>

#include "checks/vertical_lines.hpp"
#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "mesh/faces.hpp"
#include "physics/head.hpp"
#include "tables/table_output.hpp"
#include "values/derived_fields.hpp"
#include "values/snapshot_choice.hpp"

namespace suffuse {
namespace {

/// A face of a boundary and the element that has it.
struct OuterFace {
  int element;
  std::vector<double> centre;
  std::vector<double> outward;  ///< normal, of any length
};

struct Boundary {
  std::string name;
  std::vector<OuterFace> faces;
};

/// Elements by their outer faces. Both sides of a wall have nodes of their own.
template <int Dim>
std::map<std::array<int, Dim>, int> element_of_face(const Mesh<Dim>& mesh) {
  std::map<std::array<int, Dim>, int> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int a = 0; a <= Dim; ++a) {
      elements[face_key<Dim>(face_opposite<Dim>(mesh.elements[e], a))] = e;
    }
  }
  return elements;
}

template <class Position>
std::vector<double> coordinates(const Position& x) {
  return {x.data(), x.data() + x.size()};
}

template <int Dim>
OuterFace outer_face(const Mesh<Dim>& mesh, const std::array<int, Dim>& nodes, int element) {
  Vector<Dim> centre = Vector<Dim>::Zero();
  for (const int node : nodes) centre += mesh.nodes[node] / Dim;
  Vector<Dim> normal = face_normal<Dim>(mesh, nodes);
  if (normal.dot(element_centroid(mesh, element) - centre) > 0.0) normal = -normal;
  return {element, coordinates(centre), coordinates(normal)};
}

/// Boundaries through which water can leave. Within the soil, at walls, wells and drains, soil
/// above holds it down.
template <int Dim>
std::vector<Boundary> boundaries_of(const ResultsReader& results, const Mesh<Dim>& mesh) {
  const auto elements = element_of_face(mesh);
  std::vector<Boundary> boundaries;
  for (const BoundaryCondition& condition : results.scene().scene.boundaries) {
    if (!lets_water_out(condition) || condition.is_well()) continue;
    const auto found = std::ranges::find(mesh.boundaries, condition.on, &BoundarySet<Dim>::name);
    if (found == mesh.boundaries.end()) continue;
    Boundary boundary{condition.on, {}};
    for (const auto& nodes : found->faces) {
      boundary.faces.push_back(outer_face<Dim>(mesh, nodes, elements.at(face_key<Dim>(nodes))));
    }
    boundaries.push_back(std::move(boundary));
  }
  return boundaries;
}

/// Normals of the nodes of an element, added; zero if it has none of these nodes.
template <int Dim>
Vector<Dim> normal_of(const std::map<int, Vector<Dim>>& normals,
                      const std::array<int, Dim + 1>& nodes) {
  Vector<Dim> sum = Vector<Dim>::Zero();
  for (const int node : nodes) {
    if (const auto found = normals.find(node); found != normals.end()) sum += found->second;
  }
  return sum;
}

/// Soil below free water, as at the bottom of a pit that holds water: for each region of free water
/// two layers of elements of soil at its border. Those of the first are water in part, and have a
/// smaller gradient.
template <int Dim>
std::vector<Boundary> beds_of_free_water(const Scene& scene, const Mesh<Dim>& mesh) {
  const auto is_water = [&](int e) {
    return scene.is_free_water(mesh.region_names[mesh.element_region[e]]);
  };
  std::map<std::array<int, Dim>, int> region_of_water;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int a = 0; a <= Dim && is_water(e); ++a) {
      region_of_water[face_key<Dim>(face_opposite<Dim>(mesh.elements[e], a))] =
          mesh.element_region[e];
    }
  }
  std::map<int, std::map<int, Vector<Dim>>> outward;  // of the nodes of each bed
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int a = 0; a <= Dim && !is_water(e); ++a) {
      const auto nodes = face_opposite<Dim>(mesh.elements[e], a);
      const auto found = region_of_water.find(face_key<Dim>(nodes));
      if (found == region_of_water.end()) continue;
      const OuterFace face = outer_face<Dim>(mesh, nodes, e);
      const Vector<Dim> normal = Eigen::Map<const Vector<Dim>>(face.outward.data());
      for (const int node : nodes) {
        outward[found->second].try_emplace(node, Vector<Dim>::Zero()).first->second += normal;
      }
    }
  }
  std::vector<Boundary> beds;
  for (const auto& [region, of_bed] : outward) {
    Boundary& bed = beds.emplace_back(Boundary{mesh.region_names[region], {}});
    std::map<int, Vector<Dim>> normals = of_bed;
    for (int e = 0; e < mesh.element_count(); ++e) {
      const Vector<Dim> normal = normal_of<Dim>(of_bed, mesh.elements[e]);
      if (is_water(e) || normal.isZero()) continue;
      for (const int node : mesh.elements[e]) normals.try_emplace(node, normal);
    }
    for (int e = 0; e < mesh.element_count(); ++e) {
      const Vector<Dim> normal = normal_of<Dim>(normals, mesh.elements[e]);
      if (is_water(e) || normal.isZero()) continue;
      bed.faces.push_back({e, coordinates(element_centroid(mesh, e)), coordinates(normal)});
    }
  }
  return beds;
}

/// The fields of a snapshot that the safety depends on.
struct SafetyState {
  double time;
  std::vector<double> gradient;
  std::vector<double> critical;
  std::vector<double> flux;

  [[nodiscard]] double flux_through(const OuterFace& face) const {
    const std::size_t width = face.outward.size();
    double sum = 0.0;
    for (std::size_t d = 0; d < width; ++d) {
      sum += flux[width * static_cast<std::size_t>(face.element) + d] * face.outward[d];
    }
    return sum;
  }
};

/// Gradients below it are round-off of water that stands still.
constexpr double still_water = 1e-9;

void include(const SafetyState& state, int element, const std::vector<double>& place,
             PartSafety& part) {
  const double gradient = state.gradient[element];
  const double critical = state.critical[element];
  // Free water has no critical gradient: the value there is NaN.
  if (!(gradient > still_water) || !(critical > 0.0)) return;
  const double safety = critical / gradient;
  if (safety < 1.0 && !part.first_below) part.first_below = state.time;
  if (part.least && part.least->safety <= safety) return;
  part.least = LeastSafety{safety, gradient, critical, state.time, place};
}

std::string number_cell(const char* format, double value, int width) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return padded(text, width);
}

/// The cells behind the name of a part.
std::string part_cells(const PartSafety& part, const TimeUnit& unit, int place_width) {
  std::string text;
  if (part.least) {
    const LeastSafety& least = *part.least;
    text = number_cell("%.4g", least.safety, 10) + number_cell("%.4g", least.gradient, 10) +
           number_cell("%.4g", least.critical_gradient, 10) +
           padded(time_digits(least.time, unit), 12) + padded(place_text(least.place), place_width);
  } else {
    text = padded("-", 10) + padded("-", 10) + padded("-", 10) + padded("-", 12) +
           padded("water rises nowhere", place_width);
  }
  if (part.discharge) text += number_cell("%.10g", *part.discharge, 23);
  return text;
}

template <int Dim>
std::vector<PartSafety> safety_in(const ResultsReader& results, const Mesh<Dim>& mesh) {
  std::vector<Boundary> boundaries = boundaries_of(results, mesh);
  const std::size_t outer = boundaries.size();
  std::ranges::move(beds_of_free_water(results.scene().scene, mesh),
                    std::back_inserter(boundaries));
  std::vector<PartSafety> parts{PartSafety{.name = "all soil"}};
  for (const Boundary& boundary : boundaries) parts.push_back({.name = boundary.name});
  expect_snapshots(results);
  for (std::size_t index = 0; index < results.times().size(); ++index) {
    const SafetyState state{results.times()[index], upward_gradient(results, index),
                            critical_gradient(results, index),
                            results.field(index, "cell", "darcy_flux").values};
    for (int e = 0; e < mesh.element_count(); ++e) {
      include(state, e, coordinates(element_centroid(mesh, e)), parts[0]);
    }
    for (std::size_t b = 0; b < boundaries.size(); ++b) {
      for (const OuterFace& face : boundaries[b].faces) {
        if (state.flux_through(face) > 0.0) {
          include(state, face.element, face.centre, parts[b + 1]);
        }
      }
    }
  }
  for (const NamedTable& boundary : results.boundaries()) {
    const auto part = std::ranges::find(parts, boundary.name, &PartSafety::name);
    if (part != parts.end()) part->discharge = boundary.table.column("discharge").back();
  }
  const auto beds = parts.begin() + static_cast<std::ptrdiff_t>(outer) + 1;
  parts.erase(std::remove_if(beds, parts.end(), [](const PartSafety& bed) { return !bed.least; }),
              parts.end());
  return parts;
}

}  // namespace

std::vector<PartSafety> safety_of(const ResultsReader& results) {
  return with_mesh(results, [&](const auto& mesh) { return safety_in(results, mesh); });
}

std::string motion_text(const Table& history, const TimeUnit& unit) {
  const auto now = [&](const char* name) {
    return number_cell("%.4g", history.column(name).back(), 0);
  };
  return "t = " + time_digits(history.column("t").back(), unit) + " " + unit.name +
         " the largest settlement of the soil is " + now("settlement_max") +
         " m, its largest displacement " + now("displacement_max") + " m";
}

std::string safety_text(const ResultsReader& results, const std::vector<PartSafety>& parts,
                        const TextStyle& style) {
  std::size_t width = 0;
  for (const PartSafety& part : parts) width = std::max(width, part.name.size());
  const auto& times = results.times();
  const TimeUnit& unit = style.time;
  const bool is_plane = results.dimension() == 2;
  const int place_width = is_plane ? 20 : 30;
  std::string text =
      results.folder() + ": " + results.status() + ", " + std::to_string(times.size()) +
      " snapshots until t = " + number_text(times.back() / unit.seconds) + " " + unit.name +
      "\nleast safety i_cr / i against heave, i: hydraulic gradient upwards, i_cr = (1 - n) "
      "(rho_s / rho_w - 1)\n" +
      std::string(width, ' ') + padded("safety", 10) + padded("i", 10) + padded("i_cr", 10) +
      padded("t (" + unit.name + ")", 12) + padded("at (m)", place_width) +
      padded("discharge now (" + std::string(is_plane ? "m2/s" : "m3/s") + ")", 23) + "\n";
  for (const PartSafety& part : parts) {
    const std::string line = part.name + std::string(width - part.name.size(), ' ') +
                             part_cells(part, unit, place_width);
    text += (part.first_below ? alarm_line(line, style) : line) + "\n";
  }
  const bool moves = results.scene().scene.moves();
  if (const auto& first = parts.front().first_below) {
    text +=
        "a safety below 1 means that water lifts soil that nothing holds down, for the first "
        "time at t = " +
        time_digits(*first, unit) + " " + unit.name;
    text +=
        moves ? "\n"
              : ": from then on results of a skeleton that stays in place mean nothing, unless the "
                "place lies deep in the soil\n";
  }
  if (!has_gravity(results.scene().scene.gravity)) text += without_gravity + "\n";
  if (moves) text += "at " + motion_text(results.history(), unit) + "\n";
  return text;
}

void check_safety(const std::vector<PartSafety>& parts, double least) {
  for (const PartSafety& part : parts) {
    if (!part.least || part.least->safety >= least) continue;
    throw NumericalError(part.name + ": got a safety of " + number_text(part.least->safety) +
                         " at " + place_text(part.least->place) +
                         " m, t = " + number_text(part.least->time) + " s; expected at least " +
                         number_text(least));
  }
}

}  // namespace suffuse

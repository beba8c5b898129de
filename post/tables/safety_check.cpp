#include "tables/safety_check.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

#include "case/errors.hpp"
#include "case/faces.hpp"
#include "results/number_text.hpp"
#include "results/table_files.hpp"
#include "values/derived_fields.hpp"

namespace suffuse {
namespace {

/// A face of a boundary and the element that has it.
struct OuterFace {
  int element;
  Vector<2> centre;
  Vector<2> outward;  ///< normal times length, m
};

struct Boundary {
  std::string name;
  std::vector<OuterFace> faces;
};

/// Elements by their outer faces. Both sides of a wall have nodes of their own.
std::map<std::array<int, 2>, int> element_of_face(const Mesh<2>& mesh) {
  std::map<std::array<int, 2>, int> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int a = 0; a < 3; ++a) elements[face_key<2>(face_opposite<2>(mesh.elements[e], a))] = e;
  }
  return elements;
}

std::vector<Boundary> boundaries_of(const ResultsReader& results, const Mesh<2>& mesh) {
  const auto elements = element_of_face(mesh);
  std::vector<Boundary> boundaries;
  for (const std::string& name : booked_boundaries(results.scene().scene)) {
    const auto found = std::ranges::find(mesh.boundaries, name, &BoundarySet<2>::name);
    if (found == mesh.boundaries.end()) continue;
    Boundary boundary{name, {}};
    for (const auto& nodes : found->faces) {
      const Vector<2>& a = mesh.nodes[nodes[0]];
      const Vector<2>& b = mesh.nodes[nodes[1]];
      const int e = elements.at(face_key<2>(nodes));
      const Vector<2> centre = 0.5 * (a + b);
      Vector<2> normal(b[1] - a[1], a[0] - b[0]);
      if (normal.dot(element_centroid(mesh, e) - centre) > 0.0) normal = -normal;
      boundary.faces.push_back({e, centre, normal});
    }
    boundaries.push_back(std::move(boundary));
  }
  return boundaries;
}

/// The state of a snapshot as far as safety asks for it.
struct SafetyState {
  double time;
  std::vector<double> gradient;
  std::vector<double> critical;
  std::vector<double> flux;

  [[nodiscard]] double flux_through(const OuterFace& face) const {
    const auto at = 2 * static_cast<std::size_t>(face.element);
    return flux[at] * face.outward[0] + flux[at + 1] * face.outward[1];
  }
};

void include(const SafetyState& state, int element, const Vector<2>& place, PartSafety& part) {
  const double gradient = state.gradient[element];
  const double critical = state.critical[element];
  // Free water has no critical gradient: it is not a number there.
  if (!(gradient > 0.0) || !(critical > 0.0)) return;
  const double safety = critical / gradient;
  if (part.least && part.least->safety <= safety) return;
  part.least = LeastSafety{safety, gradient, critical, state.time, place};
}

std::string place_text(const Vector<2>& x) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.4g, %.4g)", x[0], x[1]);
  return text;
}

std::string cell(const std::string& text, int width) {
  const auto room = static_cast<std::size_t>(width);
  return std::string(room - std::min(room, text.size()), ' ') + text;
}

std::string cell(const char* format, double value, int width) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return cell(std::string(text), width);
}

std::string motion_text(const Table& history) {
  const auto now = [&](const char* name) { return cell("%.4g", history.column(name).back(), 0); };
  return "at t = " + cell("%.6g", history.column("t").back(), 0) +
         " s the largest settlement of the soil is " + now("settlement_max") +
         " m, its largest displacement " + now("displacement_max") + " m\n";
}

}  // namespace

std::vector<PartSafety> safety_of(const ResultsReader& results) {
  const Mesh<2> mesh = results.mesh();
  const std::vector<Boundary> boundaries = boundaries_of(results, mesh);
  std::vector<PartSafety> parts{{"all soil", {}, {}}};
  for (const Boundary& boundary : boundaries) parts.push_back({boundary.name, {}, {}});
  if (results.times().empty()) throw FileError(results.folder() + ": has no snapshot yet");
  for (std::size_t index = 0; index < results.times().size(); ++index) {
    const SafetyState state{results.times()[index], upward_gradient(results, index),
                            critical_gradient(results, mesh, index),
                            results.field(index, "cell", "darcy_flux").values};
    for (int e = 0; e < mesh.element_count(); ++e) {
      include(state, e, element_centroid(mesh, e), parts[0]);
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
  return parts;
}

std::string safety_text(const ResultsReader& results, const std::vector<PartSafety>& parts) {
  std::size_t width = 0;
  for (const PartSafety& part : parts) width = std::max(width, part.name.size());
  const auto& times = results.times();
  std::string text =
      results.folder() + ": " + results.status() + ", " + std::to_string(times.size()) +
      " snapshots until t = " + number_text(times.back()) +
      " s\nleast safety i_cr / i against heave, i: hydraulic gradient upwards, i_cr = (1 - n) "
      "(rho_s / rho_w - 1)\n" +
      std::string(width, ' ') + cell("safety", 10) + cell("i", 10) + cell("i_cr", 10) +
      cell("t (s)", 12) + cell("at (m)", 20) + cell("discharge now (m2/s)", 23) + "\n";
  for (const PartSafety& part : parts) {
    text += part.name + std::string(width - part.name.size(), ' ');
    if (part.least) {
      const LeastSafety& least = *part.least;
      text += cell("%.4g", least.safety, 10) + cell("%.4g", least.gradient, 10) +
              cell("%.4g", least.critical_gradient, 10) + cell("%.6g", least.time, 12) +
              cell(place_text(least.place), 20);
    } else {
      text += cell("-", 10) + cell("-", 10) + cell("-", 10) + cell("-", 12) +
              cell("water rises nowhere", 20);
    }
    if (part.discharge) text += cell("%.10g", *part.discharge, 23);
    text += "\n";
  }
  const bool lifts = std::ranges::any_of(
      parts, [](const PartSafety& part) { return part.least && part.least->safety < 1.0; });
  const bool moves = results.scene().scene.moves();
  if (lifts) {
    text += "a safety below 1 means that water lifts the soil there";
    text +=
        moves ? "\n" : ": from then on results of a skeleton that stays in place mean nothing\n";
  }
  if (moves) text += motion_text(results.history());
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

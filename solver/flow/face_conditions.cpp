#include "flow/face_conditions.hpp"

#include <algorithm>

#include "case/errors.hpp"

namespace suffuse {
namespace {

FaceCondition condition_of(const BoundaryCondition& boundary, int index) {
  FaceCondition condition;
  condition.kind = FaceKind::wall;
  condition.boundary = index;
  if (boundary.pressure) {
    condition.kind = FaceKind::pressure;
    condition.value = *boundary.pressure;
  } else if (boundary.velocity) {
    condition.kind = FaceKind::velocity;
    condition.value = *boundary.velocity;
  } else if (boundary.darcy_flux) {
    condition.kind = FaceKind::flux;
    condition.value = *boundary.darcy_flux;
  }
  condition.concentration_given = boundary.concentration.has_value();
  condition.concentration = boundary.concentration.value_or(0.0);
  return condition;
}

}  // namespace

template <int Dim>
std::vector<FaceCondition> face_conditions(const Case<Dim>& c, const Grid<Dim>& grid) {
  std::vector<FaceCondition> result(grid.face_count());
  for (int f = 0; f < grid.face_count(); ++f) {
    if (grid.is_outer(f)) result[f].kind = FaceKind::wall;
  }
  std::vector<InputProblem> problems;
  const auto& entries = c.document.scene.boundaries;
  for (int b = 0; b < static_cast<int>(entries.size()); ++b) {
    const std::string key = "boundary[" + std::to_string(b) + "].on";
    const auto set =
        std::find_if(c.mesh.boundaries.begin(), c.mesh.boundaries.end(),
                     [&](const auto& candidate) { return candidate.name == entries[b].on; });
    if (set == c.mesh.boundaries.end()) {
      problems.push_back({c.document.locate(key), key, "\"" + entries[b].on + "\"",
                          "the name of a boundary of the mesh", ""});
      continue;
    }
    for (const auto& nodes : set->faces) {
      const int f = grid.find_face(nodes);
      if (result[f].boundary >= 0) {
        problems.push_back({c.document.locate(key), key, "\"" + entries[b].on + "\"",
                            "a boundary that shares no face with \"" +
                                entries[result[f].boundary].on + "\", which has its own condition",
                            ""});
        break;
      }
      result[f] = condition_of(entries[b], b);
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return result;
}

template std::vector<FaceCondition> face_conditions(const Case<2>&, const Grid<2>&);

}  // namespace suffuse

#include "flow/face_conditions.hpp"

#include <algorithm>

#include "case/errors.hpp"

namespace suffuse {
namespace {

FaceCondition condition_of(const BoundaryCondition& boundary, int index, double time) {
  FaceCondition condition;
  condition.kind = FaceKind::wall;
  condition.boundary = index;
  if (boundary.pressure) {
    condition.kind = FaceKind::pressure;
    condition.value = boundary.pressure->value(time);
  } else if (boundary.velocity) {
    condition.kind = FaceKind::velocity;
    condition.value = boundary.velocity->value(time);
  } else if (boundary.darcy_flux) {
    condition.kind = FaceKind::flux;
    condition.value = boundary.darcy_flux->value(time);
  }
  condition.concentration_given = boundary.concentration.has_value();
  if (boundary.concentration) condition.concentration = boundary.concentration->value(time);
  return condition;
}

/// The values of a boundary that change in time.
std::vector<TimeFunction> varying_values(const BoundaryCondition& boundary) {
  std::vector<TimeFunction> varying;
  for (const auto& value :
       {boundary.pressure, boundary.velocity, boundary.darcy_flux, boundary.concentration}) {
    if (value && !value->is_constant()) varying.push_back(*value);
  }
  return varying;
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
      result[f] = condition_of(entries[b], b, 0.0);
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return result;
}

template <int Dim>
BoundaryValues<Dim>::BoundaryValues(const Case<Dim>& c, const Grid<Dim>& grid)
    : initial_(face_conditions(c, grid)) {
  const auto& entries = c.document.scene.boundaries;
  for (int b = 0; b < static_cast<int>(entries.size()); ++b) {
    const std::vector<TimeFunction> values = varying_values(entries[b]);
    if (values.empty()) continue;
    Varying& varying = varying_.emplace_back(Varying{entries[b], b, {}});
    for (int f = 0; f < grid.face_count(); ++f) {
      if (initial_[f].boundary == b) varying.faces.push_back(f);
    }
    for (const TimeFunction& value : values) {
      for (const double time : value.breakpoints()) {
        if (time > 0.0 && time < c.document.scene.time.end) breakpoints_.push_back(time);
      }
    }
  }
  std::ranges::sort(breakpoints_);
  breakpoints_.erase(std::unique(breakpoints_.begin(), breakpoints_.end()), breakpoints_.end());
}

template <int Dim>
std::vector<FaceCondition> BoundaryValues<Dim>::at(double time) const {
  std::vector<FaceCondition> conditions = initial_;
  update(time, conditions);
  return conditions;
}

template <int Dim>
void BoundaryValues<Dim>::update(double time, std::vector<FaceCondition>& conditions) const {
  for (const Varying& varying : varying_) {
    const FaceCondition now = condition_of(varying.boundary, varying.index, time);
    for (const int f : varying.faces) conditions[f] = now;
  }
}

template <int Dim>
void BoundaryValues<Dim>::update_concentrations(double time,
                                                std::vector<FaceCondition>& conditions) const {
  for (const Varying& varying : varying_) {
    if (!varying.boundary.concentration) continue;
    const double now = varying.boundary.concentration->value(time);
    for (const int f : varying.faces) conditions[f].concentration = now;
  }
}

template std::vector<FaceCondition> face_conditions(const Case<2>&, const Grid<2>&);
template std::vector<FaceCondition> face_conditions(const Case<3>&, const Grid<3>&);
template class BoundaryValues<2>;
template class BoundaryValues<3>;

}  // namespace suffuse

#include "boundary/face_conditions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/errors.hpp"
#include "mesh/water_line.hpp"
#include "physics/head.hpp"
#include "scene/lognormal_field.hpp"

namespace suffuse {
namespace {

/// Prescribes the water pressure below the level of a head, and what `dry` says above it.
void prescribe_head(double head, DryPart dry, const FaceSurroundings& around,
                    FaceCondition& result) {
  const bool wet = !around.gravity || head > around.wet_above || dry == DryPart::suction;
  if (wet) {
    result.kind = FaceKind::pressure;
    result.value = around.unit_weight * (around.gravity ? head - around.height : head);
  } else {
    result.kind = dry == DryPart::seepage ? FaceKind::seepage : FaceKind::wall;
    result.value = 0.0;
  }
}

/// The condition of a boundary, common to its faces: for a head its value is H, for a rate the
/// total rate.
FaceCondition condition_of(const BoundaryCondition& boundary, int index, const BoundaryTime& time) {
  FaceCondition condition;
  condition.kind = FaceKind::wall;
  condition.boundary = index;
  const auto prescribe = [&](FaceKind kind, double value) {
    condition.kind = kind;
    condition.value = value;
  };
  if (boundary.pressure) {
    prescribe(FaceKind::pressure, boundary.pressure->value(time.end));
  } else if (boundary.velocity) {
    prescribe(FaceKind::velocity, boundary.velocity->value(time.of_fluxes));
  } else if (boundary.darcy_flux) {
    prescribe(FaceKind::flux, boundary.darcy_flux->value(time.of_fluxes));
  } else if (boundary.head) {
    prescribe(FaceKind::pressure, boundary.head->value(time.end));
  } else if (boundary.rate) {
    prescribe(FaceKind::flux, boundary.rate->value(time.of_fluxes));
  } else if (boundary.rain) {
    prescribe(FaceKind::seepage, boundary.rain->value(time.of_fluxes));
  } else if (boundary.seepage_face) {
    prescribe(FaceKind::seepage, 0.0);
  }
  if (boundary.concentration) condition.concentration = boundary.concentration->value(time.end);
  return condition;
}

/// The condition of one face, from that of its boundary.
FaceCondition at_face(const BoundaryCondition& boundary, FaceCondition condition,
                      const FaceSurroundings& around) {
  if (boundary.head) prescribe_head(condition.value, boundary.dry, around, condition);
  if (boundary.rate) condition.value *= around.share;
  return condition;
}

/// Whether the kind of a face, or its unknown, changes during the run.
bool may_switch(const BoundaryCondition& boundary, const FaceSurroundings& around, double end) {
  if (boundary.seepage_face || boundary.rain) return true;
  if (!boundary.head || !around.gravity || boundary.dry == DryPart::suction) return false;
  if (boundary.is_reservoir()) return true;
  const auto [lowest, highest] = boundary.head->range(0.0, end);
  // An impervious face that the water never reaches stays impervious.
  return lowest <= around.wet_above &&
         (boundary.dry == DryPart::seepage || highest > around.wet_above);
}

/// The values of a boundary that change in time.
std::vector<const TimeFunction*> varying_values(const BoundaryCondition& boundary) {
  std::vector<const TimeFunction*> varying;
  for (const auto* value :
       {&boundary.pressure, &boundary.velocity, &boundary.darcy_flux, &boundary.head,
        &boundary.rain, &boundary.rate, &boundary.concentration}) {
    if (*value && !(*value)->is_constant()) varying.push_back(&**value);
  }
  return varying;
}

/// A value that changes by its range in a smaller share of the run jumps.
constexpr double jump = 1e-6;

/// Free water takes a well's rate as soil of this conductivity would, m/s.
constexpr double conductivity_of_free_water = 1.0;

/// Finds heights of faces and their shares of rates.
template <int Dim>
class Outside {
 public:
  Outside(const Scene& scene, const Grid<Dim>& grid)
      : scene_(scene),
        grid_(grid),
        gravity_(scene.gravity),
        water_line_(grid.mesh, scene.gravity,
                    largest_of_all(grid.ranks(), largest_coordinate(grid.mesh))),
        unit_weight_(unit_weight(scene.liquid.density, scene.gravity)) {
    for (const std::string& name : grid.mesh.region_names) {
      const Soil* soil = scene.find_soil(name);
      std::optional<LognormalField>& field = field_.emplace_back();
      if (soil && soil->field.varies()) field.emplace(soil->field, soil->bedding);
    }
  }
  /// \param conductance  of the face's boundary, m3/s
  [[nodiscard]] FaceSurroundings of(int face, double conductance) const {
    return {.unit_weight = unit_weight_,
            .gravity = has_gravity(gravity_),
            .height = height(grid_.face_centre(face), gravity_),
            .wet_above = water_line_.wet_above(grid_.face_nodes[face]),
            .share = conductivity_across(face) / conductance};
  }
  /// Sum of k A over these faces, m3/s.
  [[nodiscard]] double conductance_of(const std::vector<int>& faces) const {
    ExactSum sum;
    for (const int f : faces) {
      if (grid_.owns_face(f)) sum.add(conductivity_across(f) * grid_.face_normal[f].norm());
    }
    grid_.ranks().sum({&sum});
    return sum.value();
  }

 private:
  [[nodiscard]] double conductivity_across(int face) const {
    const Mesh<Dim>& mesh = grid_.mesh;
    const int region = mesh.element_region[grid_.face_left[face]];
    const Soil* soil = scene_.find_soil(mesh.region_names[region]);
    if (!soil) return conductivity_of_free_water;
    const double along = soil->conductivity / soil->resistance_along(grid_.face_normal[face]);
    const std::optional<LognormalField>& field = field_[region];
    return field ? along * field->at(element_centroid(mesh, grid_.face_left[face])) : along;
  }

  const Scene& scene_;
  const Grid<Dim>& grid_;
  std::array<double, 3> gravity_;
  WaterLine<Dim> water_line_;
  double unit_weight_;
  std::vector<std::optional<LognormalField>> field_;  ///< per region; nothing: k does not vary
};

/// Faces of the grid per boundary entry of the scene. Throws InputError.
template <int Dim>
std::vector<std::vector<int>> faces_of_boundaries(const Case<Dim>& c, const Grid<Dim>& grid) {
  std::vector<InputProblem> problems;
  const auto& entries = c.document.scene.boundaries;
  std::vector<std::vector<int>> result(entries.size());
  std::vector<int> owner(grid.face_count(), -1);
  for (int b = 0; b < static_cast<int>(entries.size()); ++b) {
    const std::string key = entries[b].key + ".on";
    const auto report = [&](const std::string& expected) {
      problems.push_back({c.document.locate(key), key, "\"" + entries[b].on + "\"", expected, ""});
    };
    const auto set =
        std::find_if(c.mesh.boundaries.begin(), c.mesh.boundaries.end(),
                     [&](const auto& candidate) { return candidate.name == entries[b].on; });
    if (set == c.mesh.boundaries.end()) {
      report("the name of a boundary of the mesh");
      continue;
    }
    for (const auto& nodes : set->faces) {
      const int f = grid.find_face(nodes);
      if (owner[f] >= 0) {
        report("a boundary that shares no face with \"" + entries[owner[f]].on +
               "\", which has its own condition");
        break;
      }
      owner[f] = b;
      result[b].push_back(f);
    }
    std::ranges::sort(result[b]);  // the order fixes the bits of sums over them
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return result;
}

}  // namespace

template <int Dim>
std::vector<FaceCondition> face_conditions(const Case<Dim>& c, const Grid<Dim>& grid) {
  const Scene& scene = c.document.scene;
  std::vector<FaceCondition> result(grid.face_count());
  for (int f = 0; f < grid.face_count(); ++f) {
    if (grid.is_outer(f)) result[f].kind = FaceKind::wall;
  }
  const Outside<Dim> outside(scene, grid);
  const auto faces = faces_of_boundaries(c, grid);
  for (int b = 0; b < static_cast<int>(faces.size()); ++b) {
    const double conductance = outside.conductance_of(faces[b]);
    const FaceCondition start = condition_of(scene.boundaries[b], b, {0.0, 0.0});
    for (const int f : faces[b]) {
      const FaceSurroundings around = outside.of(f, conductance);
      result[f] = at_face(scene.boundaries[b], start, around);
      result[f].switches = may_switch(scene.boundaries[b], around, scene.time.end);
    }
  }
  return result;
}

template <int Dim>
std::vector<double> pressure_at_rest(const Scene& scene, const Grid<Dim>& grid) {
  std::vector<double> result(grid.face_count(), 0.0);
  if (!scene.water_level) return result;
  const double weight = unit_weight(scene.liquid.density, scene.gravity);
  for (int f = 0; f < grid.face_count(); ++f) {
    result[f] = weight * (*scene.water_level - height(grid.face_centre(f), scene.gravity));
  }
  return result;
}

template <int Dim>
BoundaryValues<Dim>::BoundaryValues(const Case<Dim>& c, const Grid<Dim>& grid)
    : scene_(c.document.scene), grid_(grid), initial_(face_conditions(c, grid)) {
  const Scene& scene = scene_;
  const Outside<Dim> outside(scene, grid);
  for (int b = 0; b < static_cast<int>(scene.boundaries.size()); ++b) {
    const std::vector<const TimeFunction*> values = varying_values(scene.boundaries[b]);
    const bool is_reservoir = scene.boundaries[b].is_reservoir();
    if (values.empty() && !is_reservoir) continue;
    Varying& varying = varying_.emplace_back(Varying{scene.boundaries[b], b, {}, {}});
    if (is_reservoir) {
      varying.reservoir = static_cast<int>(reservoirs_.size());
      reservoirs_.push_back({.level = varying.boundary.head->value(0.0)});
    }
    for (int f = 0; f < grid.face_count(); ++f) {
      if (initial_[f].boundary == b) varying.faces.push_back(f);
    }
    const double conductance = outside.conductance_of(varying.faces);
    for (const int f : varying.faces) varying.around.push_back(outside.of(f, conductance));
    for (const TimeFunction* value : values) {
      for (const double time : value->breakpoints()) {
        if (time > 0.0 && time < scene.time.end) breakpoints_.push_back(time);
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
  update({time, time}, reservoir_rates(), conditions);
}

template <int Dim>
void BoundaryValues<Dim>::update(const BoundaryTime& time,
                                 const std::vector<double>& reservoir_rates,
                                 std::vector<FaceCondition>& conditions) const {
  for (const Varying& varying : varying_) {
    FaceCondition now = condition_of(varying.boundary, varying.index, time);
    if (varying.reservoir >= 0) {
      const ReservoirLevel& start = reservoirs_[varying.reservoir];
      const double rate = reservoir_rates[time.stage * reservoirs_.size() + varying.reservoir];
      now.value = start.level + rate * (time.end - start.time);
    }
    for (std::size_t i = 0; i < varying.faces.size(); ++i) {
      const int f = varying.faces[i];
      conditions[f] = at_face(varying.boundary, now, varying.around[i]);
      conditions[f].switches = initial_[f].switches;
    }
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

template <int Dim>
double BoundaryValues<Dim>::longest_step(double time, double share) const {
  double longest = std::numeric_limits<double>::infinity();
  for (const Varying& varying : varying_) {
    for (const TimeFunction* value : varying_values(varying.boundary)) {
      const auto [low, high] = value->range(0.0, scene_.time.end);
      // Time in which the value would change by its whole range, s.
      const double whole = (high - low) / std::abs(value->slope(time));
      if (whole > jump * scene_.time.end) longest = std::min(longest, share * whole);
    }
  }
  return longest;
}

template <int Dim>
std::vector<double> BoundaryValues<Dim>::reservoir_rates(std::size_t times) const {
  std::vector<double> rates;
  rates.reserve(times * reservoirs_.size());
  for (std::size_t i = 0; i < times; ++i) {
    for (const ReservoirLevel& reservoir : reservoirs_) rates.push_back(reservoir.rate);
  }
  return rates;
}

template <int Dim>
std::vector<double> BoundaryValues<Dim>::stage_rates(const std::vector<double>& face_volume,
                                                     const std::vector<double>& face_flux,
                                                     double dt,
                                                     const std::vector<double>& shares) const {
  std::vector<double> mean = reservoir_rates(face_volume, dt);
  if (shares.size() == 1) return mean;
  std::vector<double> rates = reservoir_rates(face_flux, 1.0);
  const double share = shares.front();
  for (std::size_t i = 0; i < mean.size(); ++i) {
    rates[i] = (mean[i] - share * rates[i]) / (1.0 - share);
  }
  rates.insert(rates.end(), mean.begin(), mean.end());
  return rates;
}

template <int Dim>
std::vector<double> BoundaryValues<Dim>::reservoir_rates(const std::vector<double>& face_volume,
                                                         double dt) const {
  std::vector<double> rates(reservoirs_.size(), 0.0);
  for (const Varying& varying : varying_) {
    if (varying.reservoir < 0) continue;
    ExactSum out_of_soil;  // normals of outer faces point outwards
    for (const int f : varying.faces) {
      if (grid_.owns_face(f)) out_of_soil.add(face_volume[f]);
    }
    grid_.ranks().sum({&out_of_soil});
    rates[varying.reservoir] = out_of_soil.value() / (varying.boundary.reservoir_area * dt);
  }
  return rates;
}

template <int Dim>
void BoundaryValues<Dim>::raise_reservoirs(double end, const std::vector<double>& rates) {
  for (std::size_t r = 0; r < reservoirs_.size(); ++r) {
    ReservoirLevel& reservoir = reservoirs_[r];
    reservoir.level += rates[r] * (end - reservoir.time);
    reservoir.rate = rates[r];
    reservoir.time = end;
  }
}

template <int Dim>
double BoundaryValues<Dim>::level(int boundary, double time) const {
  for (const Varying& varying : varying_) {
    if (varying.index != boundary || varying.reservoir < 0) continue;
    return reservoirs_[varying.reservoir].level;
  }
  return scene_.boundaries[boundary].head->value(time);
}

template std::vector<FaceCondition> face_conditions(const Case<2>&, const Grid<2>&);
template std::vector<FaceCondition> face_conditions(const Case<3>&, const Grid<3>&);
template std::vector<double> pressure_at_rest(const Scene&, const Grid<2>&);
template std::vector<double> pressure_at_rest(const Scene&, const Grid<3>&);
template class BoundaryValues<2>;
template class BoundaryValues<3>;

}  // namespace suffuse

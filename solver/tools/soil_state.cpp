#include "tools/soil_state.hpp"

#include <algorithm>
#include <cmath>

#include "boundary/boundary_loads.hpp"
#include "boundary/free_water.hpp"
#include "boundary/soil_depth.hpp"
#include "physics/liquid.hpp"

namespace suffuse {
namespace {

/// Values of a field; empty if the snapshot does not have it.
std::vector<double> values(const std::vector<Field>& fields, const std::string& name) {
  const auto found = std::ranges::find(fields, name, &Field::name);
  return found == fields.end() ? std::vector<double>() : found->values;
}

/// The `count` values of a field. Throws FileError if their number differs.
std::vector<double> values(const std::vector<Field>& fields, const std::string& name,
                           std::size_t count) {
  std::vector<double> result = values(fields, name);
  if (result.size() == count) return result;
  throw FileError("a snapshot with " + std::to_string(result.size()) + " values of " + name +
                  "; expected " + std::to_string(count));
}

/// The values of a field as whole numbers in [0, `end`).
std::vector<int> indices(const std::vector<Field>& fields, const std::string& name,
                         std::size_t count, int end) {
  std::vector<int> result;
  for (const double value : values(fields, name, count)) {
    if (!(value >= 0.0 && value < end)) {
      throw FileError("a snapshot with " + name + " = " + std::to_string(value) +
                      "; expected 0 to " + std::to_string(end - 1));
    }
    result.push_back(static_cast<int>(value));
  }
  return result;
}

template <int Dim>
void take_points(const Mesh<Dim>& mesh, const MaterialPoints<Dim>& start, const Snapshot& snapshot,
                 SoilState<Dim>& state) {
  const std::size_t count = start.element.size();
  std::vector<PointPlace<Dim>> places;
  if (snapshot.solid_positions.empty()) {
    for (int p = 0; p < start.size(); ++p) {
      places.push_back({start.element[p], start.barycentric[p]});
      state.id.push_back(p);
    }
    state.points = {mesh, places, start.volume};
    return;
  }
  if (snapshot.solid_positions.size() != 3 * count) {
    throw FileError("a snapshot with another number of solid points than the case");
  }
  const std::vector<int> element = indices(snapshot.solid, "element", count, mesh.element_count());
  for (std::size_t p = 0; p < count; ++p) {
    const Vector<Dim> x = Eigen::Map<const Vector<Dim>>(&snapshot.solid_positions[3 * p]);
    places.push_back({element[p], barycentric(mesh, element[p], x)});
  }
  state.id = indices(snapshot.solid, "id", count, static_cast<int>(count));
  state.points = {mesh, places, values(snapshot.solid, "volume", count)};
}

/// Displacement of the nodes since the start, m: the weighted mean of that of the points around
/// each node; 0 without points.
template <int Dim>
NodeVectors<Dim> node_displacement(const Grid<Dim>& grid, const MaterialPoints<Dim>& start,
                                   const SoilState<Dim>& state) {
  NodeVectors<Dim> sum(grid.mesh.node_count(), Vector<Dim>::Zero());
  std::vector<double> weight(sum.size(), 0.0);
  for (int p = 0; p < state.points.size(); ++p) {
    const int id = state.id[p];
    const Vector<Dim> moved = state.points.position[p] - start.position(grid.mesh, id);
    for (int a = 0; a <= Dim; ++a) {
      const int node = grid.mesh.elements[start.element[id]][a];
      const double share = start.volume[id] * start.barycentric[id][a];
      sum[node] += share * moved;
      weight[node] += share;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (weight[i] > 0.0) sum[i] /= weight[i];
  }
  return sum;
}

/// Loads of the scene's boundaries, on surfaces moved with the soil.
template <int Dim>
BoundaryLoads<Dim> moved_loads(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                               const SoilState<Dim>& state) {
  const PointsByElement at_start(grid.mesh.element_count(), soils.points().element);
  BoundaryLoads<Dim> loads(grid, soils, at_start);
  loads.move(at_start, node_displacement(grid, soils.points(), state));
  return loads;
}

/// Additional cohesion per point, Pa: half of the unit weight times `depth` at smaller depths, 0
/// elsewhere.
template <int Dim>
std::vector<double> surface_cohesion(const SoilMap<Dim>& soils, const SoilState<Dim>& state,
                                     double depth, const std::vector<double>& depths) {
  std::vector<double> cohesion(depths.size(), 0.0);
  const std::array<double, 3>& gravity = soils.scene().gravity;
  const double acceleration = std::hypot(gravity[0], gravity[1], gravity[2]);
  for (std::size_t p = 0; p < depths.size(); ++p) {
    if (depths[p] >= depth) continue;
    const Soil& soil = soils.soil_of_point(state.id[p]);
    const double density = soil.grain_density * state.solid_volume[p] / state.points.volume[p] +
                           state.liquid_mass[state.points.element[p]];
    cohesion[p] = 0.5 * density * acceleration * depth;
  }
  return cohesion;
}

}  // namespace

SoilFields soil_fields(bool moves) {
  SoilFields fields{{"pressure", "water_fraction", "fines_fraction"},
                    {"porosity", "erodible_fraction"}};
  if (moves) fields.solid.insert(fields.solid.end(), {"volume", "element", "id"});
  return fields;
}

template <int Dim>
SoilState<Dim> soil_state(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                          const Snapshot& snapshot) {
  const MaterialPoints<Dim>& start = soils.points();
  const Scene& scene = soils.scene();
  SoilState<Dim> state;
  state.time = snapshot.time;
  take_points(grid.mesh, start, snapshot, state);
  const std::vector<double> porosity = values(snapshot.solid, "porosity", start.element.size());
  const std::vector<double> erodible =
      values(snapshot.solid, "erodible_fraction", start.element.size());
  for (int p = 0; p < start.size(); ++p) {
    const int id = state.id[p];
    const double volume = state.points.volume[p];
    const double at_start =
        start.volume[id] * (soils.soil_of_point(id).porosity_max() - soils.initial_porosity(id));
    state.solid_volume.push_back((1.0 - porosity[p]) * volume);
    state.fines_left.push_back(at_start > 0.0 ? erodible[p] * volume / at_start : 1.0);
  }
  const std::size_t elements = grid.mesh.elements.size();
  state.pressure = values(snapshot.cell, "pressure", elements);
  const std::vector<double> water = values(snapshot.cell, "water_fraction", elements);
  const std::vector<double> fines = values(snapshot.cell, "fines_fraction", elements);
  const std::vector<double> saturation = values(snapshot.cell, "saturation");
  for (std::size_t e = 0; e < elements; ++e) {
    if (state.pressure[e] < 0.0 && !saturation.empty()) {
      const RetentionModel& retention = soils.soil_of_element(static_cast<int>(e)).retention;
      state.pressure[e] *= retention.effective(saturation[e]);
    }
    state.liquid_mass.push_back(water[e] * scene.liquid.density +
                                fines[e] * scene.soils.front().grain_density);
  }
  return state;
}

template <int Dim>
SafetyFactor find_safety_factor(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                const SoilState<Dim>& state, const FailingSoil& failing,
                                int threads, const StrengthReductionLimits& limits) {
  const Supports<Dim> supports = scene_supports(grid, soils);
  const PointsByElement sorted(grid.mesh.element_count(), state.points.element);
  const ElementClasses classes(grid, state.points, sorted);
  std::vector<PointSkeleton> skeleton;
  SoilMass mass{.solid = {}, .liquid = state.liquid_mass};
  for (int p = 0; p < state.points.size(); ++p) {
    const Soil& soil = soils.soil_of_point(state.id[p]);
    skeleton.push_back(skeleton_at(soil.skeleton, state.fines_left[p]));
    if (soil.skeleton.moves() && !failing.includes(soil.region)) {
      skeleton.back().law = skeleton_law("elastic");
    }
    mass.solid.push_back(state.solid_volume[p] * soil.grain_density);
  }
  NodeVectors<Dim> loads(grid.mesh.node_count(), Vector<Dim>::Zero());
  add_weight(grid, state.points, sorted, classes, mass, soils.scene().gravity, loads);
  moved_loads(grid, soils, state).add(sorted, state.time, loads);
  if (has_free_water(grid, soils)) {
    add_free_water(grid, sorted, soil_volumes(state.points, sorted, classes), state.pressure,
                   state.liquid_mass, soils.scene().gravity, loads);
  }
  std::vector<double> kept;
  if (failing.depth > 0.0) {
    kept = surface_cohesion(soils, state, failing.depth,
                            depths_below_surface(grid, supports, state.points, sorted));
  }
  return find_safety_factor<Dim>({grid, state.points, sorted, skeleton, classes}, supports, loads,
                                 state.pressure, threads, limits, kept);
}

template SoilState<2> soil_state(const Grid<2>&, const SoilMap<2>&, const Snapshot&);
template SoilState<3> soil_state(const Grid<3>&, const SoilMap<3>&, const Snapshot&);
template SafetyFactor find_safety_factor(const Grid<2>&, const SoilMap<2>&, const SoilState<2>&,
                                         const FailingSoil&, int, const StrengthReductionLimits&);
template SafetyFactor find_safety_factor(const Grid<3>&, const SoilMap<3>&, const SoilState<3>&,
                                         const FailingSoil&, int, const StrengthReductionLimits&);

}  // namespace suffuse

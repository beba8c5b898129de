#include "boundary/soil_state.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "boundary/boundary_loads.hpp"

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

/// Sets places and volumes of the points, and returns their numbers in the case.
template <int Dim>
std::vector<int> take_points(const Mesh<Dim>& mesh, const MaterialPoints<Dim>& start,
                             const Snapshot& snapshot, SolidPoints<Dim>& points) {
  const std::size_t count = start.element.size();
  std::vector<PointPlace<Dim>> places;
  if (snapshot.solid_positions.empty()) {
    std::vector<int> id(count);
    std::iota(id.begin(), id.end(), 0);
    for (const int p : id) places.push_back({start.element[p], start.barycentric[p]});
    points = {mesh, places, start.volume};
    return id;
  }
  if (snapshot.solid_positions.size() != 3 * count) {
    throw FileError("a snapshot with another number of solid points than the case");
  }
  const std::vector<int> element = indices(snapshot.solid, "element", count, mesh.element_count());
  for (std::size_t p = 0; p < count; ++p) {
    const Vector<Dim> x = Eigen::Map<const Vector<Dim>>(&snapshot.solid_positions[3 * p]);
    places.push_back({element[p], barycentric(mesh, element[p], x)});
  }
  points = {mesh, places, values(snapshot.solid, "volume", count)};
  return indices(snapshot.solid, "id", count, static_cast<int>(count));
}

/// Displacement of the nodes since the start, m: the weighted mean of that of the points around
/// each node; 0 without points.
/// \param id  per point: its number in the case
template <int Dim>
NodeVectors<Dim> node_displacement(const Grid<Dim>& grid, const MaterialPoints<Dim>& start,
                                   const SolidPoints<Dim>& points, const std::vector<int>& id) {
  NodeVectors<Dim> sum(grid.mesh.node_count(), Vector<Dim>::Zero());
  std::vector<double> weight(sum.size(), 0.0);
  for (int p = 0; p < points.size(); ++p) {
    const Vector<Dim> moved = points.position[p] - start.position(grid.mesh, id[p]);
    for (int a = 0; a <= Dim; ++a) {
      const int node = grid.mesh.elements[start.element[id[p]]][a];
      const double share = start.volume[id[p]] * start.barycentric[id[p]][a];
      sum[node] += share * moved;
      weight[node] += share;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (weight[i] > 0.0) sum[i] /= weight[i];
  }
  return sum;
}

/// Residual saturation of the soil in each element, the mean over its points; that of the element's
/// region without points.
template <int Dim>
std::vector<double> residual_saturation(const SoilMap<Dim>& soils, const SoilState<Dim>& state) {
  std::vector<double> sum(soils.mesh().elements.size(), 0.0);
  std::vector<double> volume(sum.size(), 0.0);
  for (int p = 0; p < state.points.size(); ++p) {
    const double of_point = state.points.volume[p];
    const RetentionModel& retention = soils.soil_of_region(state.region[p]).retention;
    sum[state.points.element[p]] += of_point * retention.residual_saturation;
    volume[state.points.element[p]] += of_point;
  }
  for (std::size_t e = 0; e < sum.size(); ++e) {
    const RetentionModel& own = soils.soil_of_element(static_cast<int>(e)).retention;
    sum[e] = volume[e] > 0.0 ? sum[e] / volume[e] : own.residual_saturation;
  }
  return sum;
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
  const std::size_t count = start.element.size();
  SoilState<Dim> state;
  state.time = snapshot.time;
  const std::vector<int> id = take_points(grid.mesh, start, snapshot, state.points);
  const std::vector<double> porosity = values(snapshot.solid, "porosity", count);
  const std::vector<double> erodible = values(snapshot.solid, "erodible_fraction", count);
  for (std::size_t p = 0; p < count; ++p) {
    const double volume = state.points.volume[p];
    const double at_start = start.volume[id[p]] * (soils.soil_of_point(id[p]).porosity_max() -
                                                   soils.initial_porosity(id[p]));
    state.region.push_back(soils.region_of_point(id[p]));
    state.solid_volume.push_back((1.0 - porosity[p]) * volume);
    state.erodible.push_back(at_start);
    state.fines_left.push_back(at_start > 0.0 ? erodible[p] * volume / at_start : 1.0);
  }
  take_liquid(soils, snapshot, state);
  const PointsByElement at_start(grid.mesh.element_count(), start.element);
  BoundaryLoads<Dim> loads(grid, soils, at_start);
  loads.move(at_start, node_displacement(grid, start, state.points, id));
  state.surfaces = loads.surfaces();
  return state;
}

template <int Dim>
void take_liquid(const SoilMap<Dim>& soils, const Snapshot& snapshot, SoilState<Dim>& state) {
  const Scene& scene = soils.scene();
  const std::size_t elements = soils.mesh().elements.size();
  state.pressure = values(snapshot.cell, "pressure", elements);
  const std::vector<double> water = values(snapshot.cell, "water_fraction", elements);
  const std::vector<double> fines = values(snapshot.cell, "fines_fraction", elements);
  const std::vector<double> saturation = values(snapshot.cell, "saturation");
  const std::vector<double> residual = residual_saturation(soils, state);
  for (std::size_t e = 0; e < elements; ++e) {
    if (state.pressure[e] < 0.0 && !saturation.empty()) {
      const RetentionModel mean{.residual_saturation = residual[e]};
      state.pressure[e] *= mean.effective(saturation[e]);
    }
    state.liquid_mass.push_back(water[e] * scene.liquid.density +
                                fines[e] * scene.soils.front().grain_density);
  }
}

template SoilState<2> soil_state(const Grid<2>&, const SoilMap<2>&, const Snapshot&);
template SoilState<3> soil_state(const Grid<3>&, const SoilMap<3>&, const Snapshot&);
template void take_liquid(const SoilMap<2>&, const Snapshot&, SoilState<2>&);
template void take_liquid(const SoilMap<3>&, const Snapshot&, SoilState<3>&);

}  // namespace suffuse

#include "boundary/soil_state.hpp"

#include <algorithm>
#include <cmath>

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

template SoilState<2> soil_state(const Grid<2>&, const SoilMap<2>&, const Snapshot&);
template SoilState<3> soil_state(const Grid<3>&, const SoilMap<3>&, const Snapshot&);

}  // namespace suffuse

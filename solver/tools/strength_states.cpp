#include "tools/strength_states.hpp"

#include <algorithm>
#include <optional>

#include "common/errors.hpp"
#include "driver/plan.hpp"
#include "driver/run_loop.hpp"
#include "driver/source_run.hpp"
#include "files/number_text.hpp"
#include "physics/skeleton/skeleton_law.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

/// The fields of a snapshot that `soil_state` reads.
template <int Dim>
Snapshot read_snapshot(const ResultsReader& results, std::size_t index) {
  const bool moves = results.scene().scene.moves();
  Snapshot snapshot;
  snapshot.time = results.times()[index];
  SoilFields names = soil_fields(moves);
  const std::vector<std::string> cell = results.field_names(index, "cell");
  if (std::ranges::count(cell, "saturation") > 0) names.cell.push_back("saturation");
  for (const char* name : names.cell) snapshot.cell.push_back(results.field(index, "cell", name));
  for (const char* name : names.solid) {
    snapshot.solid.push_back(results.field(index, "solid", name));
  }
  if (!moves) return snapshot;
  for (const Vector<Dim>& x : results.point_positions<Dim>(index, "solid")) {
    snapshot.solid_positions.insert(snapshot.solid_positions.end(), {x[0], x[1], 0.0});
    if constexpr (Dim == 3) snapshot.solid_positions.back() = x[2];
  }
  return snapshot;
}

/// Whether a run started with the points of its case: after a run in which soil moved they are at
/// other places and have other numbers.
template <int Dim>
bool starts_with_points_of(const Case<Dim>& c, const ResultsReader& results) {
  const MaterialPoints<Dim>& start = c.solid_points;
  const std::vector<Vector<Dim>> places = results.point_positions<Dim>(0, "solid");
  const std::vector<double> id = results.field(0, "solid", "id").values;
  if (places.size() != start.element.size()) return false;
  const double near = 1e-9 * largest_coordinate(c.mesh);
  for (std::size_t p = 0; p < places.size(); ++p) {
    const Vector<Dim> place = start.position(c.mesh, static_cast<int>(id[p]));
    if (!((places[p] - place).norm() <= near)) return false;
  }
  return true;
}

/// The state of soil that has moved in earlier runs too.
/// \param snapshot  with the fields of elements (`soil_fields`)
template <int Dim>
SoilState<Dim> moved_state(const SoilMap<Dim>& soils, const Snapshot& snapshot,
                           const MovedSoil<Dim>& moved) {
  const Mesh<Dim>& mesh = soils.mesh();
  std::vector<PointPlace<Dim>> places;
  for (int p = 0; p < moved.points.size(); ++p) {
    const int e = moved.points.element[p];
    places.push_back({e, barycentric(mesh, e, moved.points.position[p])});
  }
  SoilState<Dim> state{.time = snapshot.time,
                       .points = {mesh, places, moved.points.volume},
                       .region = moved.region,
                       .solid_volume = moved.state.solid_volumes(),
                       .erodible = moved.initial_erodible,
                       .fines_left = {},
                       .pressure = {},
                       .liquid_mass = {},
                       .surfaces = moved.surfaces};
  for (std::size_t p = 0; p < state.erodible.size(); ++p) {
    const double start = state.erodible[p];
    state.fines_left.push_back(start > 0.0 ? moved.state.erodible_volume[p] / start : 1.0);
  }
  take_liquid(soils, snapshot, state);
  return state;
}

}  // namespace

template <int Dim>
SoilState<Dim> start_state(const Case<Dim>& c, const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                           int threads) {
  Case<Dim> strong = c;
  Scene& scene = strong.document.scene;
  for (Soil& soil : scene.soils) soil.skeleton = {};
  const auto has_no_soil = [&](const std::string& region) {
    return c.document.scene.is_free_water(region) && !scene.is_free_water(region);
  };
  // In the run that it starts from soil may have moved.
  if (!scene.initial_from.empty() || std::ranges::any_of(c.mesh.region_names, has_no_soil)) {
    scene.soils = c.document.scene.soils;
    for (Soil& soil : scene.soils) {
      if (soil.skeleton.moves()) soil.skeleton.law = skeleton_law("elastic");
    }
  }
  const std::optional<SourceRun<Dim>> earlier = read_source_run(strong, {.threads = threads});
  const RunLoop<Dim> loop(strong, make_plan(strong, {.threads = threads}),
                          earlier ? &earlier->state : nullptr);
  const Snapshot snapshot = loop.model().snapshot(loop.model().flow_state());
  if (!earlier || !earlier->state.moved) return soil_state(grid, soils, snapshot);
  return moved_state(soils, snapshot, *loop.model().last_state().moved);
}

template <int Dim>
SoilState<Dim> run_state(const ResultsReader& results, const Case<Dim>& of_run, std::size_t index,
                         const Grid<Dim>& grid, const SoilMap<Dim>& soils, int threads) {
  const Snapshot snapshot = read_snapshot<Dim>(results, index);
  const Scene& scene = of_run.document.scene;
  if (scene.initial_from.empty() || !scene.moves() || starts_with_points_of(of_run, results)) {
    return soil_state(grid, soils, snapshot);
  }
  const LastState<Dim> last = read_last_state(results.folder(), of_run, {.threads = threads});
  if (last.time != snapshot.time) {
    throw InputError(
        InputProblem{"", "--time",
                     shown_number(snapshot.time) + " s of a run that starts from " +
                         shown_value(scene.initial_from) + ", whose soil has moved",
                     "the last state of such a run, at t = " + shown_number(last.time) + " s"});
  }
  return moved_state(soils, snapshot, *last.state.moved);
}

template SoilState<2> start_state(const Case<2>&, const Grid<2>&, const SoilMap<2>&, int);
template SoilState<2> run_state(const ResultsReader&, const Case<2>&, std::size_t, const Grid<2>&,
                                const SoilMap<2>&, int);
template SoilState<3> start_state(const Case<3>&, const Grid<3>&, const SoilMap<3>&, int);
template SoilState<3> run_state(const ResultsReader&, const Case<3>&, std::size_t, const Grid<3>&,
                                const SoilMap<3>&, int);

}  // namespace suffuse

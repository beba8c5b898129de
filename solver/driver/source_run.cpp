#include "driver/source_run.hpp"

#include <filesystem>

#include "common/errors.hpp"
#include "driver/run_loop.hpp"
#include "driver/run_notes.hpp"
#include "files/layout.hpp"
#include "results/reader.hpp"
#include "scene/scene_difference.hpp"
#include "scene/scene_schema.hpp"
#include "scene/stage_scenes.hpp"

namespace suffuse {
namespace {

constexpr const char* source_key = "initial.from";

[[noreturn]] void refuse_source(const SceneDocument& document, const std::string& found,
                                const std::string& expected) {
  throw InputError(InputProblem{document.locate(source_key), source_key, found, expected});
}

/// The folder of the results that the scene starts from. A case made on another machine, without
/// this folder of the scene, takes the scene's path from the working folder on.
std::string results_beside_scene(const SceneDocument& document) {
  const std::filesystem::path scene = std::filesystem::exists(document.folder)
                                          ? std::filesystem::path(document.folder)
                                          : std::filesystem::path(document.path).parent_path();
  return (scene / document.scene.initial_from).string();
}

}  // namespace

template <int Dim>
bool have_same_mesh(const Case<Dim>& a, const Case<Dim>& b) {
  return a.mesh.nodes == b.mesh.nodes && a.mesh.elements == b.mesh.elements &&
         a.mesh.element_region == b.mesh.element_region &&
         a.mesh.region_names == b.mesh.region_names;
}

template <int Dim>
bool have_same_points(const Case<Dim>& a, const Case<Dim>& b) {
  return have_same_mesh(a, b) && a.solid_points.element == b.solid_points.element &&
         a.solid_points.barycentric == b.solid_points.barycentric &&
         a.solid_points.volume == b.solid_points.volume;
}

template <int Dim>
LastState<Dim> read_last_state(const std::string& folder, const Case<Dim>& c,
                               const SolverOptions& options) {
  const Scene& scene = c.document.scene;
  FoundRestart found = newest_restart_point(folder, scene.formulation == Formulation::double_point,
                                            table_files(scene, c.mesh.region_names.size()));
  if (!found.point || found.point->case_digest != digest_of(c)) {
    throw FileError(folder + ": its last state cannot be read" +
                    (found.damage.empty() ? "" : ": " + found.damage.front()));
  }
  LastState<Dim> last{found.point->time, digest_of(*found.point), {}};
  Plan plan = make_plan(c, {options.threads, found.point->no_skip});
  plan.soil_start = SoilStart::stress_later;
  const OwnPart<Dim> taken = own_part(c, options.ranks);
  plan.part = taken.part;
  RunLoop<Dim> loop(taken.own ? *taken.own : c, plan);
  RunNotes notes{.checks = RowChecks(scene, plan.row_limits)};
  StateArchive archive(std::move(found.point->state), loop.model().shared_state());
  archive(loop, notes);
  archive.finish();
  last.state = loop.model().last_state();
  return last;
}

template <int Dim>
std::optional<SourceRun<Dim>> read_source_run(const Case<Dim>& c, const SolverOptions& options) {
  const SceneDocument& document = c.document;
  if (document.scene.initial_from.empty()) return std::nullopt;
  const std::string folder = results_beside_scene(document);
  const std::string shown = shown_value(document.scene.initial_from);
  if (!std::filesystem::exists(layout::in_folder(folder, layout::run_info))) {
    refuse_source(document, shown + ", where there are no results",
                  "a results folder, relative to that of the scene; looked for in " + folder);
  }
  const std::string status = ResultsReader(folder).status();
  if (status != "done") {
    refuse_source(document, shown + ", whose run is " + shown_value(status),
                  "a run that is done: let it go on with --resume");
  }
  const Case<Dim> earlier = read_case<Dim>(layout::in_folder(folder, layout::case_copy));
  const Scene& scene = earlier.document.scene;
  if (scene.moves() && !document.scene.moves()) {
    refuse_source(document, shown + ", whose soil has moved",
                  "a scene with a skeleton that moves, or a run whose skeletons are rigid");
  }
  refuse_other_soils(document, scene, folder);
  if (!(scene.moves() ? have_same_mesh(earlier, c) : have_same_points(earlier, c))) {
    refuse_source(document, shown + ", whose mesh or solid points differ",
                  "a run on the same mesh and points: the keys of [geometry], [mesh] and "
                  "points.solid_per_element as there");
  }
  const std::vector<std::string> stages = construction(document.scene, scene, c.mesh.region_names);
  if (!stages.empty() && scene.formulation == Formulation::double_point) {
    refuse_source(document, shown + ", after which " + stages.front(),
                  "the regions of soil as there, or formulation = \"single-point\"");
  }
  LastState<Dim> last = read_last_state(folder, earlier, options);
  if (last.time < scene.time.end) throw FileError(folder + ": its last state cannot be read");
  SourceRun<Dim> result{folder, std::move(last.state), {}};
  result.sentences.push_back("run: from the state of " + folder + " at t = " +
                             shown_number(last.time) + " s there, digest " + last.digest);
  for (const std::string& difference : scene_differences(earlier.document, document)) {
    result.sentences.push_back("differs: " + difference);
  }
  for (const std::string& stage : stages) result.sentences.push_back("construction: " + stage);
  if (result.state.moved && result.state.moved->has_inertia) {
    refuse_source(document, shown + ", whose soil still moves at its end",
                  "a run that ends in equilibrium: let it go on to a later time.end with --resume");
  }
  return result;
}

template bool have_same_points(const Case<2>&, const Case<2>&);
template bool have_same_points(const Case<3>&, const Case<3>&);
template LastState<2> read_last_state(const std::string&, const Case<2>&, const SolverOptions&);
template LastState<3> read_last_state(const std::string&, const Case<3>&, const SolverOptions&);
template std::optional<SourceRun<2>> read_source_run(const Case<2>&, const SolverOptions&);
template std::optional<SourceRun<3>> read_source_run(const Case<3>&, const SolverOptions&);

}  // namespace suffuse

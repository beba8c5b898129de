#include "driver/source_run.hpp"

#include <cmath>
#include <filesystem>

#include "common/errors.hpp"
#include "driver/run_loop.hpp"
#include "driver/run_notes.hpp"
#include "files/layout.hpp"
#include "results/reader.hpp"
#include "scene/law_texts.hpp"
#include "scene/scene_difference.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

constexpr const char* source_key = "initial.from";

/// Compares the keys that must be equal in both scenes. Problems name the key of the later scene.
class Comparison {
 public:
  Comparison(const SceneDocument& here, const Scene& there, std::string folder)
      : here_(here), there_(there), folder_(std::move(folder)) {}

  void run() {
    const Scene& scene = here_.scene;
    const bool same_formulation = scene.formulation == there_.formulation;
    if (!same_formulation) report("formulation", "another one");
    same("liquid.density", scene.liquid.density, there_.liquid.density);
    same("liquid.bulk_modulus", scene.liquid.bulk_modulus, there_.liquid.bulk_modulus);
    for (const Soil& soil : scene.soils) compare(soil);
    for (const Soil& soil : there_.soils) {
      if (scene.find_soil(soil.region) == nullptr) report(table_of(soil), "no such soil");
    }
    if (!problems_.empty()) throw InputError(std::move(problems_));
  }

 private:
  static std::string table_of(const Soil& soil) { return joined("soil", shown_name(soil.region)); }

  void compare(const Soil& soil) {
    const Soil* other = there_.find_soil(soil.region);
    const std::string table = table_of(soil);
    if (other == nullptr) {
      report(table, "a soil");
      return;
    }
    same(table + ".porosity", soil.porosity, other->porosity);
    same(table + ".skeleton_fraction", soil.skeleton_fraction, other->skeleton_fraction);
    same(table + ".grain_density", soil.grain_density, other->grain_density);
    if (soil.porosity_gradient != other->porosity_gradient ||
        soil.porosity_origin != other->porosity_origin) {
      report(table + ".porosity_gradient", "another one");
    }
    const auto& a = soil.retention;
    const auto& b = other->retention;
    bool same_retention = a.law == b.law && a.residual_saturation == b.residual_saturation;
    if (same_retention && a.law != nullptr) {
      for (const RetentionParameter& parameter : retention_parameters()) {
        same_retention =
            same_retention && equal(a.parameters.*parameter.value, b.parameters.*parameter.value);
      }
    }
    if (!same_retention) report(table + ".retention", "another one");
  }

  static bool equal(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }
  void same(const std::string& name, double here, double there) {
    if (equal(here, there)) return;
    problems_.push_back({.where = here_.locate(name),
                         .key = name,
                         .found = shown_number(here),
                         .expected = shown_number(there) + ", as in " + folder_ +
                                     ", from whose state the run starts",
                         .suggestion = ""});
  }
  void report(const std::string& name, const std::string& found) {
    problems_.push_back(
        {.where = here_.locate(name),
         .key = name,
         .found = found,
         .expected = "the same as in " + folder_ + ", from whose state the run starts",
         .suggestion = ""});
  }

  const SceneDocument& here_;
  const Scene& there_;
  std::string folder_;
  std::vector<InputProblem> problems_;
};

[[noreturn]] void refuse_source(const SceneDocument& document, const std::string& found,
                                const std::string& expected) {
  throw InputError(InputProblem{document.locate(source_key), source_key, found, expected});
}

/// Restores a model of the case to the state of `point`, and returns this state.
template <int Dim>
EarlierState<Dim> restored(const Case<Dim>& c, RestartPoint point, const SolverOptions& options) {
  Plan plan = make_plan(c, {options.threads, point.no_skip});
  const OwnPart<Dim> taken = own_part(c, options.ranks);
  plan.part = taken.part;
  RunLoop<Dim> loop(taken.own ? *taken.own : c, plan);
  RunNotes notes{.checks = {c.document.scene, plan.speed_that_drag_follows}};
  StateArchive state(std::move(point.state), loop.model().shared_state());
  state(loop, notes);
  state.finish();
  return loop.model().last_state();
}

}  // namespace

template <int Dim>
bool have_same_points(const Case<Dim>& a, const Case<Dim>& b) {
  return a.mesh.nodes == b.mesh.nodes && a.mesh.elements == b.mesh.elements &&
         a.mesh.element_region == b.mesh.element_region &&
         a.mesh.region_names == b.mesh.region_names &&
         a.solid_points.element == b.solid_points.element &&
         a.solid_points.barycentric == b.solid_points.barycentric &&
         a.solid_points.volume == b.solid_points.volume;
}

template <int Dim>
std::optional<SourceRun<Dim>> read_source_run(const Case<Dim>& c, const SolverOptions& options) {
  const SceneDocument& document = c.document;
  if (document.scene.initial_from.empty()) return std::nullopt;
  const std::string folder = file_beside_scene(document.path, document.scene.initial_from);
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
  if (scene.moves()) {
    refuse_source(document, shown + ", whose soil has moved",
                  "a run whose skeletons are rigid: --resume goes on with a run of another kind");
  }
  Comparison(document, scene, folder).run();
  if (!have_same_points(earlier, c)) {
    refuse_source(document, shown + ", whose mesh or solid points differ",
                  "a run on the same mesh and points: the keys of [geometry], [mesh] and "
                  "points.solid_per_element as there");
  }
  FoundRestart found = newest_restart_point(folder, scene.formulation == Formulation::double_point,
                                            table_files(scene, earlier.mesh.region_names.size()));
  if (!found.point || found.point->time < scene.time.end ||
      found.point->case_digest != digest_of(earlier)) {
    throw FileError(folder + ": its last state cannot be read" +
                    (found.damage.empty() ? "" : ": " + found.damage.front()));
  }
  SourceRun<Dim> result;
  result.folder = folder;
  result.sentences.push_back("run: from the state of " + folder +
                             " at t = " + shown_number(found.point->time) + " s there, digest " +
                             digest_of(*found.point));
  for (const std::string& difference : scene_differences(earlier.document, document)) {
    result.sentences.push_back("differs: " + difference);
  }
  result.state = restored(earlier, std::move(*found.point), options);
  return result;
}

template bool have_same_points(const Case<2>&, const Case<2>&);
template bool have_same_points(const Case<3>&, const Case<3>&);
template std::optional<SourceRun<2>> read_source_run(const Case<2>&, const SolverOptions&);
template std::optional<SourceRun<3>> read_source_run(const Case<3>&, const SolverOptions&);

}  // namespace suffuse

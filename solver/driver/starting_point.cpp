#include "driver/starting_point.hpp"

#include <cstdio>
#include <utility>

#include "common/errors.hpp"
#include "files/layout.hpp"
#include "results/writer.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

/// "time.end, output.restarts and output.precision"
std::string changeable_keys() {
  return listed({keys_that_may_change.begin(), keys_that_may_change.end()}, "and");
}

/// Finds the state to resume the run in `folder`. Throws InputError if it is another case.
template <int Dim>
FoundRestart find_restart(const Case<Dim>& c, const std::string& folder,
                          const SolverOptions& options) {
  const bool has_liquid = c.document.scene.formulation == Formulation::double_point;
  FoundRestart found = newest_restart_point(
      folder, has_liquid, table_files(c.document.scene, c.mesh.region_names.size()));
  if (!found.point) return found;
  const auto refuse = [&](const std::string& what, const std::string& how) {
    throw InputError(folder + ": cannot be resumed: it holds the results of " + what +
                     "; choose another folder with -o, " + how);
  };
  if (found.point->case_digest != digest_of(c)) {
    refuse("another case", "take the case it began with, in which nothing but " +
                               changeable_keys() +
                               " may be changed, or replace them with --force in the place of "
                               "--resume. " +
                               listed_differences(lasting_differences(folder, c)));
  }
  if (found.point->time > c.document.scene.time.end) {
    throw InputError(c.document.locate("time.end") + ": time.end: got " +
                     shown_number(c.document.scene.time.end) + "; expected no less than " +
                     shown_number(found.point->time) + " s, which the run in " + folder +
                     " has reached");
  }
  if (found.point->no_skip != options.no_skip) {
    refuse(found.point->no_skip ? "a run with --no-skip" : "a run without --no-skip",
           "take the same option, or run anew without --resume");
  }
  return found;
}

/// Warns if the run in `folder` has inertia of the liquid and this case has not, or the reverse:
/// a scene without `time.inertia` has it where it matters for a run as long as `time.end`.
template <int Dim>
void warn_of_other_inertia(const Case<Dim>& c, const std::string& folder,
                           const SolverOptions& options) {
  const Case<Dim> earlier = read_case<Dim>(layout::in_folder(folder, layout::case_copy));
  if (earlier.document.scene.time.end == c.document.scene.time.end) return;
  const SolverOptions alone{options.threads, options.no_skip};
  const bool had = make_plan(earlier, alone).flow.inertia;
  if (had == make_plan(c, alone).flow.inertia) return;
  std::fprintf(stderr,
               "suffuse-solver: warning: time.inertia is %s with this time.end, and was %s with "
               "time.end = %s s; a run from the start, without --resume, has it one way\n",
               had ? "false" : "true", had ? "true" : "false",
               shown_number(earlier.document.scene.time.end).c_str());
}

template <int Dim>
bool is_complete(const Case<Dim>& c, const std::string& folder, const SolverOptions& options) {
  if (!is_finished(folder)) return false;
  // Takes no lock, because the folder may be read-only.
  const FoundRestart found = find_restart(c, folder, options);
  return found.point && found.point->time >= c.document.scene.time.end && found.damage.empty();
}

}  // namespace

template <int Dim>
std::vector<std::string> lasting_differences(const std::string& folder, const Case<Dim>& c) {
  std::vector<std::string> result = differences_from_run(folder, c);
  for (const char* key : keys_that_may_change) {
    std::erase_if(
        result, [&](const std::string& line) { return line.starts_with(std::string(key) + ":"); });
  }
  return result;
}

template <int Dim>
std::optional<StartingPoint> find_starting_point(const Case<Dim>& c, const std::string& folder,
                                                 const SolverOptions& options) {
  check_results_folder(folder, c.document.scene.name);
  if (is_complete(c, folder, options)) return std::nullopt;
  StartingPoint result{folder, std::nullopt, FolderLock(folder)};
  FoundRestart found = find_restart(c, folder, options);
  for (const std::string& damage : found.damage) {
    std::fprintf(stderr, "suffuse-solver: warning: passed over: %s\n", damage.c_str());
  }
  if (!found.point && found.holds_results) {
    throw FileError(folder +
                    ": cannot be resumed: no snapshot there has a state to go on from; choose "
                    "another folder with -o, or run anew without --resume");
  }
  if (found.point) warn_of_other_inertia(c, folder, options);
  result.from = std::move(found.point);
  return result;
}

template std::vector<std::string> lasting_differences(const std::string&, const Case<2>&);
template std::vector<std::string> lasting_differences(const std::string&, const Case<3>&);
template std::optional<StartingPoint> find_starting_point(const Case<2>&, const std::string&,
                                                          const SolverOptions&);
template std::optional<StartingPoint> find_starting_point(const Case<3>&, const std::string&,
                                                          const SolverOptions&);

}  // namespace suffuse

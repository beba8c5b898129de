#include "driver/starting_point.hpp"

#include <cstdio>
#include <utility>

#include "case/errors.hpp"
#include "case/scene_schema.hpp"
#include "results/layout.hpp"
#include "results/writer.hpp"

namespace suffuse {
namespace {

/// "time.end, output.restarts and output.precision"
std::string changeable_keys() {
  return listed({keys_that_may_change.begin(), keys_that_may_change.end()}, "and");
}

/// How the case in `folder` differs, in some words.
template <int Dim>
std::string differences_from(const Case<Dim>& c, const std::string& folder) {
  constexpr std::size_t most = 5;
  try {
    std::vector<std::string> found =
        differences(read_case<Dim>(layout::in_folder(folder, layout::case_copy)), c);
    if (found.size() > most) {
      found.resize(most);
      found.emplace_back("more");
    }
    if (!found.empty()) return listed(found, "and");
  } catch (const std::exception&) {
    // The copy of the case is missing or damaged.
  }
  return "scene, mesh or points have changed since";
}

/// What the run in `folder` can go on from. Throws InputError where it is a run of something else.
template <int Dim>
FoundRestart find_restart(const Case<Dim>& c, const std::string& folder,
                          const SolverOptions& options) {
  const bool has_liquid = c.document.scene.formulation == Formulation::double_point;
  FoundRestart found = newest_restart_point(
      folder, has_liquid, table_files(c.document.scene, c.mesh.region_names.size()));
  if (!found.point) return found;
  const auto refuse = [&](const std::string& what, const std::string& how) {
    throw InputError(folder + ": cannot be resumed: it holds the results of " + what + "; " + how +
                     ", choose another folder with -o, or run anew without --resume");
  };
  if (found.point->case_digest != digest_of(c)) {
    refuse("another case (" + differences_from(c, folder) + ")",
           "take the case it began with, in which nothing but " + changeable_keys() +
               " may be changed");
  }
  if (found.point->time > c.document.scene.time.end) {
    throw InputError(c.document.locate("time.end") + ": time.end: got " +
                     shown_number(c.document.scene.time.end) + "; expected no less than " +
                     shown_number(found.point->time) + " s, which the run in " + folder +
                     " has reached");
  }
  if (found.point->no_skip != options.no_skip) {
    refuse(found.point->no_skip ? "a run with --no-skip" : "a run without --no-skip",
           "take the same option");
  }
  return found;
}

template <int Dim>
bool is_complete(const Case<Dim>& c, const std::string& folder, const SolverOptions& options) {
  if (!is_finished(folder)) return false;
  // No lock: the folder may be on a disk that cannot be written.
  const FoundRestart found = find_restart(c, folder, options);
  return found.point && found.point->time >= c.document.scene.time.end && found.damage.empty();
}

}  // namespace

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
  result.from = std::move(found.point);
  return result;
}

template std::optional<StartingPoint> find_starting_point(const Case<2>&, const std::string&,
                                                          const SolverOptions&);

}  // namespace suffuse

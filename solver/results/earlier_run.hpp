#pragma once

/// The run that stands in a results folder, before another one writes there.

#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "files/folder_lock.hpp"

namespace suffuse {

/// Whose results a run may replace.
enum class Replace {
  same_case,  ///< those of the same scene, mesh and points
  any,        ///< those of any run of suffuse-solver
};

/// Refuses with an InputError or a FileError where `folder` is no place for results of a scene of
/// this name: it is a file, holds something else, or, unless any may be replaced, the results of a
/// scene of another name. Touches nothing.
void check_results_folder(const std::string& folder, const std::string& scene,
                          Replace replace = Replace::same_case);

/// What differs between the run in `folder` and a run of `c`, a line for each key of the scene, for
/// the mesh and the points. Empty where nothing does, or where there is no run.
template <int Dim>
std::vector<std::string> differences_from_run(const std::string& folder, const Case<Dim>& c);

/// Such lines as the end of a message: below each other and not too many.
std::string listed_differences(const std::vector<std::string>& differences);

/// Checks the folder for a new run of `c` and takes its lock; makes the folder if need be. Throws
/// an InputError that says what differs where the results there may not be replaced, and what
/// `check_results_folder` and FolderLock throw.
template <int Dim>
FolderLock lock_for_results(const std::string& folder, const Case<Dim>& c, Replace replace);

}  // namespace suffuse

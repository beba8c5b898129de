#pragma once

/// The run in a results folder, checked before another run replaces it.

#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "files/folder_lock.hpp"

namespace suffuse {

/// Which results a run may replace.
enum class Replace {
  same_case,  ///< those of the same scene, mesh and points
  any,        ///< those of any run of suffuse-solver
};

/// Throws an InputError or a FileError if `folder` cannot take results of a scene of this name: it
/// is a file, holds other files, or, with `same_case`, holds results of a scene of another name.
/// Changes nothing.
void check_results_folder(const std::string& folder, const std::string& scene,
                          Replace replace = Replace::same_case);

/// Differences between the run in `folder` and a run of `c`: a line for each key of the scene, and
/// one for mesh and points. Empty without differences or without a run.
template <int Dim>
std::vector<std::string> differences_from_run(const std::string& folder, const Case<Dim>& c);

/// These lines as the end of a message; a long list is cut.
std::string listed_differences(const std::vector<std::string>& differences);

/// Checks the folder for a new run of `c` and takes its lock; makes the folder if necessary. Throws
/// an InputError with the differences if results there must not be replaced. Throws as
/// `check_results_folder` and FolderLock do.
template <int Dim>
FolderLock lock_for_results(const std::string& folder, const Case<Dim>& c, Replace replace);

}  // namespace suffuse

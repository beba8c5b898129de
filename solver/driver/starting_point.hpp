#pragma once

/// The start of a run in its folder: the scene's initial state, or the state of an earlier run
/// there.

#include <optional>
#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "driver/plan.hpp"
#include "files/folder_lock.hpp"
#include "results/restart_point.hpp"

namespace suffuse {

struct StartingPoint {
  std::string folder;
  std::optional<RestartPoint> from;  ///< nothing: the initial state
  FolderLock lock;                   ///< of the folder
};

/// Differences between the run in `folder` and `c`, but for keys that may change during a run: a
/// line for each key of the scene, and one for mesh and points.
template <int Dim>
std::vector<std::string> lasting_differences(const std::string& folder, const Case<Dim>& c);

/// The last state of the run in `folder`, for `--resume`; nothing if that run is complete. Warns of
/// damaged states on stderr. Throws InputError if it is another case, FileError if its results hold
/// no state.
template <int Dim>
std::optional<StartingPoint> find_starting_point(const Case<Dim>& c, const std::string& folder,
                                                 const SolverOptions& options);

}  // namespace suffuse

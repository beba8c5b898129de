#pragma once

/// Where a run starts: in a folder of its own, from the scene's initial state or from the state
/// that an earlier run left there.

#include <optional>
#include <string>

#include "case/case_file.hpp"
#include "driver/plan.hpp"
#include "files/folder_lock.hpp"
#include "results/restart_point.hpp"

namespace suffuse {

struct StartingPoint {
  std::string folder;
  std::optional<RestartPoint> from;  ///< none: the initial state
  FolderLock lock;                   ///< of the folder
};

/// The last state that the run in `folder` left, for `--resume`; warns on stderr of states that are
/// damaged. Nothing where that run is complete. Throws InputError where it is a run of something
/// else, FileError where its results hold no state.
template <int Dim>
std::optional<StartingPoint> find_starting_point(const Case<Dim>& c, const std::string& folder,
                                                 const SolverOptions& options);

}  // namespace suffuse

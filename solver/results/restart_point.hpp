#pragma once

/// The state from which a stopped run can go on, kept beside the newest snapshots and in the
/// checkpoint of an interrupted run. Layout: docs/file-formats.md.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "common/hdf5_io.hpp"
#include "files/table_files.hpp"

namespace suffuse {

struct RestartPoint {
  double time = 0.0;   ///< that the state is of, s; not before the snapshot's
  long rows = 0;       ///< of history.csv by then; output times in every table
  long snapshots = 0;  ///< by then, the one that this belongs to included
  bool no_skip = false;
  std::string case_digest;          ///< see `digest_of`
  std::vector<std::uint8_t> state;  ///< the solver's business; empty: not kept
};

/// Digest of a restart point: 16 hexadecimal digits that tell one from another.
std::string digest_of(const RestartPoint& point);

/// Digest of everything in a case that must not change while a run lasts: mesh, points and all keys
/// of the scene but those of `keys_that_may_change`.
template <int Dim>
std::string digest_of(const Case<Dim>& c);

/// A run may go on with other values of these keys.
inline constexpr std::array<const char*, 3> keys_that_may_change{"time.end", "output.restarts",
                                                                 "output.precision"};

/// Digest of a case's mesh and points alone.
template <int Dim>
std::string digest_of_model(const Case<Dim>& c);

/// Writes to `/Suffuse/restart`, which must not be there yet.
void write_restart_point(Hdf5File& file, const RestartPoint& point);

/// Reads the restart point of one file; nothing where the file keeps no state. Throws FileError
/// where what it keeps is damaged or was written by a version whose state this one does not know.
std::optional<RestartPoint> read_restart_point(const std::string& path);

/// What `newest_restart_point` found.
struct FoundRestart {
  std::optional<RestartPoint> point;
  std::string path;                 ///< of the file that holds it
  std::vector<std::string> damage;  ///< newer ones that could not be read, with the reason
  /// Whether the folder holds more than what a run has that was stopped before its first snapshot
  /// and the state that belongs to it were complete: a run that begins anew would remove results.
  bool holds_results = false;
};

/// The last point of the run in `folder` whose snapshots and tables are all there.
FoundRestart newest_restart_point(const std::string& folder, bool has_liquid_files,
                                  const std::vector<TableFile>& tables);

/// Whether the folder holds the results of a finished run.
bool is_finished(const std::string& folder);

}  // namespace suffuse

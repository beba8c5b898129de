#pragma once

/// The state from which a stopped run can continue, stored with the newest snapshots and in the
/// checkpoint of an interrupted run. Layout: docs/reference/file-formats.md.

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
  double time = 0.0;   ///< of the state, s; not before that of the snapshot
  long rows = 0;       ///< of history.csv until then: the output times of every table
  long snapshots = 0;  ///< until then, including that of this state
  bool no_skip = false;
  std::string case_digest;          ///< see `digest_of`
  std::vector<std::uint8_t> state;  ///< written by the model; empty: not stored
};

/// Digest of a restart point: 16 hexadecimal digits that identify it.
std::string digest_of(const RestartPoint& point);

/// Digest of all that must not change during a run: mesh, points and all keys of the scene except
/// `keys_that_may_change`.
template <int Dim>
std::string digest_of(const Case<Dim>& c);

/// Keys that may have other values when a run continues.
inline constexpr std::array<const char*, 3> keys_that_may_change{"time.end", "output.restarts",
                                                                 "output.precision"};

/// Digest of a case's mesh and points alone.
template <int Dim>
std::string digest_of_model(const Case<Dim>& c);

/// Writes to `/Suffuse/restart`, which must not exist yet.
void write_restart_point(Hdf5File& file, const RestartPoint& point);

/// Reads the restart point of one file; nothing if the file has no state. Throws FileError if the
/// state is damaged or has the layout of another version.
std::optional<RestartPoint> read_restart_point(const std::string& path);

/// Result of `newest_restart_point`.
struct FoundRestart {
  std::optional<RestartPoint> point;
  std::string path;                 ///< of the file that holds it
  std::vector<std::string> damage;  ///< newer states that could not be read, with the reason
  /// Whether a new run would remove results. False after a run that was stopped before its first
  /// snapshot and the state after it were complete.
  bool holds_results = false;
};

/// The last point of the run in `folder` whose snapshots and tables are complete.
FoundRestart newest_restart_point(const std::string& folder, bool has_liquid_files,
                                  const std::vector<TableFile>& tables);

/// Whether the folder holds the results of a finished run.
bool is_finished(const std::string& folder);

}  // namespace suffuse

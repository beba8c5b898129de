#pragma once

/// Names of the files in a results folder, and of the groups in them.

#include <filesystem>
#include <string>

namespace suffuse::layout {

/// Value of the key "format" in run.json; identifies our results.
inline constexpr const char* format = "suffuse-results";
/// Since version 2 the grid of the snapshots and the restart state are separate files.
inline constexpr int format_version = 2;
inline constexpr int oldest_readable_version = 1;

inline constexpr const char* run_info = "run.json";
inline constexpr const char* case_copy = "case.h5";
inline constexpr const char* history = "history.csv";
inline constexpr const char* ledger = "ledger.csv";
inline constexpr const char* regions = "regions.csv";
inline constexpr const char* boundaries = "boundaries.csv";
inline constexpr const char* probes = "probes.csv";
inline constexpr const char* sections = "sections.csv";
inline constexpr const char* snapshots = "snapshots";
/// State of a run that was stopped between snapshots.
inline constexpr const char* checkpoint = "checkpoint.hdf";
/// Held by the solver that writes into the folder.
inline constexpr const char* lock = ".lock";

/// "FOLDER/NAME"
inline std::string in_folder(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

/// "mesh.hdf.series" and so on; `kind` is "mesh", "solid" or "liquid".
inline std::string series(const std::string& kind) {
  return kind + ".hdf.series";
}

/// "snapshots/mesh_000012.hdf"
inline std::string snapshot(const std::string& kind, std::size_t index) {
  std::string digits = std::to_string(index);
  if (digits.size() < 6) digits.insert(0, 6 - digits.size(), '0');
  return std::string(snapshots) + "/" + kind + "_" + digits + ".hdf";
}

/// "mesh_grid.hdf": the common grid of all snapshots of `kind`, "mesh" or "solid".
inline std::string grid_name(const std::string& kind) {
  return kind + "_grid.hdf";
}
/// "snapshots/mesh_grid.hdf"
inline std::string grid(const std::string& kind) {
  return std::string(snapshots) + "/" + grid_name(kind);
}
/// "snapshots/state_000012.hdf": the state to continue from after snapshot 12.
inline std::string state(std::size_t index) {
  return snapshot("state", index);
}

/// Groups of a snapshot file in addition to /VTKHDF.
inline constexpr const char* own_group = "/Suffuse";
/// Names of the regions, in the order of their numbers.
inline constexpr const char* region_names = "/Suffuse/region_names";
inline constexpr const char* field_data_group = "/VTKHDF/FieldData";
inline constexpr const char* element_vertex_group = "/Suffuse/element_vertex";
/// How far the discharge can be off at the time of a snapshot, as attributes.
inline constexpr const char* discharge_group = "/Suffuse/discharge";
inline constexpr const char* restart_group = "/Suffuse/restart";
inline constexpr const char* restart_state = "/Suffuse/restart/state";

}  // namespace suffuse::layout

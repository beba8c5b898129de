#pragma once

/// run.json as read: the course of a run and the versions of its programs.

#include <map>
#include <string>

#include "results/writer.hpp"

namespace suffuse {

struct RunRecord {
  RunInfo info;  ///< with the status of the file; see `ResultsReader::status` for killed runs
  std::map<std::string, std::string> versions;  ///< by program: "suffuse", "git", "compiler" ...
  std::string model;                            ///< digest of mesh and points
};

/// Reads the record of a results folder. Values missing in the file keep their defaults. Throws
/// FileError.
RunRecord read_run_record(const std::string& folder);

}  // namespace suffuse

#pragma once

/// run.json read back: how a run went, and which programs made it.

#include <map>
#include <string>

#include "results/writer.hpp"

namespace suffuse {

struct RunRecord {
  RunInfo info;  ///< the status is that of the file: `ResultsReader::status` knows of killed runs
  std::map<std::string, std::string> versions;  ///< by program: "suffuse", "git", "compiler" ...
  std::string model;                            ///< digest of mesh and points
};

/// Reads the record of a results folder. What the file does not have keeps its default. Throws
/// FileError.
RunRecord read_run_record(const std::string& folder);

}  // namespace suffuse

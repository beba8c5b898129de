#pragma once

/// Valid files that edits start from, made once and kept in memory.

#include <map>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse::fuzz {

/// Contents by name within a folder.
using Files = std::map<std::string, std::string>;

inline constexpr const char* case_file = "a.case.h5";

/// Small cases, each of one file `case_file`: both formulations, both schemes, triangles and
/// tetrahedra.
const std::map<std::string, Files>& case_seeds();

/// A column of tetrahedra between free water: boundaries and regions as `geometry.layers` has them.
Mesh<3> layered_box();

/// Results folders with two or three snapshots.
const std::map<std::string, Files>& results_seeds();

std::vector<std::string> names(const std::map<std::string, Files>& seeds);

/// Makes `folder` hold these files and nothing else.
void lay_out(const Files& files, const std::string& folder);

}  // namespace suffuse::fuzz

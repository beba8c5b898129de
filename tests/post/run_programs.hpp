#pragma once

/// Runs of the programs for tests of what suffuse-post makes of them.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "post/synthetic_results.hpp"
#include "results/reader.hpp"
#include "test_paths.hpp"

namespace suffuse::testing {

/// Meshes and solves NAME.toml in `scratch`, with the text of the scene and, if there is one, of
/// its geometry file NAME.geo.
inline ResultsReader run_programs(const ScratchFolder& scratch, const std::string& name,
                                  const std::string& scene, const std::string& geometry = {}) {
  if (!geometry.empty()) std::ofstream(scratch / (name + ".geo")) << geometry;
  std::ofstream(scratch / (name + ".toml")) << scene;
  const std::string programs = test::program_folder() + "/";
  const std::string file = scratch / (name + ".case.h5");
  const std::string folder = scratch / (name + ".results");
  const std::string commands = programs + "suffuse-mesher " + scratch / (name + ".toml") + " -o " +
                               file + " > " + scratch / "log" + " && " + programs +
                               "suffuse-solver " + file + " -o " + folder + " --quiet";
  EXPECT_EQ(std::system(commands.c_str()), 0) << file_text(scratch / "log");
  return ResultsReader(folder);
}

}  // namespace suffuse::testing

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

/// Runs a command of the shell in which PROGRAMS/ is the folder of the programs; it must end well.
/// `log`: what it printed, for the message.
inline void run_command(const std::string& command, const std::string& log) {
  const std::string programs = "PROGRAMS='" + test::program_folder() + "'; ";
  EXPECT_EQ(std::system((programs + command).c_str()), 0) << file_text(log);
}

/// Meshes NAME.toml in `scratch`, with the text of the scene and, if there is one, of its geometry
/// file NAME.geo. Returns the path of the case.
inline std::string make_case_file(const ScratchFolder& scratch, const std::string& name,
                                  const std::string& scene, const std::string& geometry = {}) {
  if (!geometry.empty()) std::ofstream(scratch / (name + ".geo")) << geometry;
  std::ofstream(scratch / (name + ".toml")) << scene;
  const std::string file = scratch / (name + ".case.h5");
  const std::string log = scratch / "log";
  run_command(
      "$PROGRAMS/suffuse-mesher " + scratch / (name + ".toml") + " -o " + file + " > " + log, log);
  return file;
}

/// Meshes and solves a scene, as `make_case_file`.
inline ResultsReader run_programs(const ScratchFolder& scratch, const std::string& name,
                                  const std::string& scene, const std::string& geometry = {}) {
  const std::string file = make_case_file(scratch, name, scene, geometry);
  const std::string folder = scratch / (name + ".results");
  run_command("$PROGRAMS/suffuse-solver " + file + " -o " + folder + " --quiet", scratch / "log");
  return ResultsReader(folder);
}

/// A geometry file: two layers of 1 m, "sand" below "clay", with the boundaries "bottom" and "top".
inline std::string two_layers() {
  return "Point(1) = {0, 0, 0}; Point(2) = {0.5, 0, 0}; Point(3) = {0.5, 1, 0};\n"
         "Point(4) = {0, 1, 0}; Point(5) = {0.5, 2, 0}; Point(6) = {0, 2, 0};\n"
         "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
         "Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 4};\n"
         "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
         "Curve Loop(2) = {-3, 5, 6, 7}; Plane Surface(2) = {2};\n"
         "Physical Surface(\"sand\") = {1}; Physical Surface(\"clay\") = {2};\n"
         "Physical Curve(\"bottom\") = {1}; Physical Curve(\"top\") = {6};\n";
}

}  // namespace suffuse::testing

#pragma once

/// The element test: a soil of a scene at one point under a table of strains and stresses.

#include <string>
#include <vector>

#include "files/element_table.hpp"
#include "scene/scene.hpp"

namespace suffuse {

struct ElementTestOptions {
  std::string table;                   ///< CSV for `read_element_table`
  std::string scene;                   ///< TOML
  std::vector<std::string> overrides;  ///< `--set`
  std::string soil;                    ///< of the scene; may be empty if only one skeleton moves
  std::string output;                  ///< CSV; `-`: standard output
  int steps = 1;                       ///< output rows for each row of the table after the first
};

/// The table of a test, with a header line: step or t, stress and strain by components,
/// `mean_stress`, `deviator_stress`, `volumetric_strain`, `plastic_strain`, `fines_left`. Throws
/// InputError with the row if the soil cannot carry the stresses.
std::string element_test(const Soil& soil, const ElementTable& table, int steps);

/// Reads the scene and the table, tests the soil, and writes the complete result or nothing. Throws
/// InputError, FileError.
void run_element_test(const ElementTestOptions& options);

}  // namespace suffuse

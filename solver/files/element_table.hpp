#pragma once

/// The loading of a soil element: a table of strains and stresses.

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace suffuse {

/// Components in the order of tables: xx, yy, zz, xy.
inline constexpr std::array<const char*, 4> component_names{"xx", "yy", "zz", "xy"};

struct ElementTableRow {
  int line = 0;         ///< of the file, from 1
  double moment = 0.0;  ///< column `t` or `step`; by default the number of the row, from 0
  std::array<std::optional<double>, 4> strain = {};  ///< logarithmic
  std::array<std::optional<double>, 4> stress = {};  ///< sigma', Pa
  double fines_left = 1.0;
};

struct ElementTable {
  std::string path;                   ///< for messages
  std::string moment;                 ///< `t` or `step`
  std::vector<ElementTableRow> rows;  ///< the first is the start, with stresses and no strain
};

/// Reads a CSV file. Columns, in any order: `t` or `step` (ascending, may be left out); for xx, yy,
/// zz `strain_xx` or `stress_xx`, or both, of which each row gives one; likewise for xy (left out:
/// no strain); `fines_left` (0 to 1, may be left out: 1). The first row is the start: empty
/// stresses and all strains are 0. Throws FileError if the file cannot be read, InputError with all
/// problems in it.
ElementTable read_element_table(const std::string& path);

}  // namespace suffuse

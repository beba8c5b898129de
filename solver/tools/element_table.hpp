#pragma once

/// What a soil element is put through: a table of strains and stresses.

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace suffuse {

/// Components in the order of tables: xx, yy, zz, xy.
inline constexpr std::array<const char*, 4> component_names{"xx", "yy", "zz", "xy"};

struct ElementTableRow {
  int line = 0;         ///< of the file, from 1
  double moment = 0.0;  ///< column `t` or `step`; without one the number of the row, from 0
  std::array<std::optional<double>, 4> strain = {};  ///< logarithmic
  std::array<std::optional<double>, 4> stress = {};  ///< sigma', Pa
  double fines_left = 1.0;
};

struct ElementTable {
  std::string path;                   ///< for messages
  std::string moment;                 ///< `t` or `step`
  std::vector<ElementTableRow> rows;  ///< the first is the start: its stresses, no strain
};

/// Reads a CSV file. Columns, in any order: `t` or `step` (ascending, may be left out); for xx, yy,
/// zz `strain_xx` or `stress_xx`, or both with one of them filled in per row; the same for xy,
/// which may be left out: no strain; `fines_left` (0 to 1, may be left out: 1). The first row is
/// the start: what is empty there is 0, and so are its strains. Throws FileError where the file
/// cannot be read, InputError with all that is wrong in it.
ElementTable read_element_table(const std::string& path);

}  // namespace suffuse

#pragma once

/// CSV tables of the studies: cells are words and numbers, without commas or quotes.

#include <string>
#include <vector>

namespace suffuse {

struct TextTable {
  std::string path;
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `names`

  /// Index of a column. Throws FileError when the table does not have it.
  [[nodiscard]] std::size_t column(const std::string& name) const;
  /// FILE:LINE of a row, for messages.
  [[nodiscard]] std::string place(std::size_t row) const;
};

/// Reads a table. Throws FileError where there is no such file, or a row has more or fewer cells
/// than the first line.
TextTable read_text_table(const std::string& path);

}  // namespace suffuse

#pragma once

/// Tables of our own studies, whose cells are words and numbers without commas.

#include <string>
#include <vector>

namespace suffuse {

struct TextTable {
  std::string path;
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `names`

  /// Throws FileError.
  [[nodiscard]] std::size_t column(const std::string& name) const;
  /// FILE:LINE of a row, for messages.
  [[nodiscard]] std::string place(std::size_t row) const;
};

/// Throws FileError where there is no such file or a row is longer or shorter than the first line.
TextTable read_text_table(const std::string& path);

}  // namespace suffuse

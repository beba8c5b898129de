#pragma once

/// Tables of values against time in CSV files of their own.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/errors.hpp"

namespace suffuse {

/// What a file holds, or what is wrong with it.
struct TableReading {
  std::vector<std::pair<double, double>> rows;  ///< t (s), value: times strictly ascending
  std::optional<InputProblem> problem;          ///< the first, with its line
};

/// What to change in a line of a CSV file whose columns are not separated by commas: the end of a
/// message, or empty where semicolons or tabs are not the reason.
std::string separator_advice(const std::string& line);

/// Reads lines `t,head` below a header line that says so. \param path  for messages
TableReading read_head_table(const std::string& text, const std::string& path);

}  // namespace suffuse

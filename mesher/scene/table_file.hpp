#pragma once

/// Tables of values against time in separate CSV files.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/errors.hpp"

namespace suffuse {

/// Content of a file, or its problem.
struct TableReading {
  std::vector<std::pair<double, double>> rows;  ///< t (s), value: times strictly ascending
  std::optional<InputProblem> problem;          ///< the first, with its line
};

/// Advice on a line of a CSV file whose columns are not separated by commas: the end of a message,
/// or empty if semicolons or tabs are not the reason.
std::string separator_advice(const std::string& line);

/// Reads lines `t,head` below such a header line; `path` is for messages.
TableReading read_head_table(const std::string& text, const std::string& path);

}  // namespace suffuse

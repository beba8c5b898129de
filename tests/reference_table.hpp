#pragma once

/// Reads the tables of exact values under tests/data/reference.

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "test_paths.hpp"

namespace suffuse {

/// One row, by column name.
class ReferenceRow {
 public:
  explicit ReferenceRow(std::map<std::string, std::string> cells) : cells_(std::move(cells)) {}
  [[nodiscard]] const std::string& text(const std::string& column) const {
    return cells_.at(column);
  }
  [[nodiscard]] double number(const std::string& column) const {
    return std::stod(cells_.at(column));
  }

 private:
  std::map<std::string, std::string> cells_;
};

inline std::vector<ReferenceRow> read_reference(const std::string& name) {
  std::ifstream file(test::data_folder() + "/reference/" + name);
  if (!file) throw std::runtime_error("no reference table " + name);
  const auto split = [](std::string line) {
    if (line.ends_with('\r')) line.pop_back();
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = split(line);
  std::vector<ReferenceRow> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = split(line);
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells.at(i);
    rows.emplace_back(row);
  }
  return rows;
}

}  // namespace suffuse

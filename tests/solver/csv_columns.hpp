#pragma once

/// Tables that the solver prints.

#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace suffuse::test {

using Columns = std::map<std::string, std::vector<double>>;

/// The columns of a table of numbers, by the names in its first line.
inline Columns columns_of(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name);
  Columns columns;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (const std::string& name : names) {
      std::getline(cells, cell, ',');
      columns[name].push_back(std::stod(cell));
    }
  }
  return columns;
}

}  // namespace suffuse::test

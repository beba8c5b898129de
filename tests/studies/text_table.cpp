#include "studies/text_table.hpp"

#include <algorithm>
#include <fstream>

#include "common/errors.hpp"

namespace suffuse {
namespace {

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> found(1);
  for (const char c : line) {
    if (c == ',') {
      found.emplace_back();
    } else if (c != '\r') {
      found.back() += c;
    }
  }
  return found;
}

}  // namespace

std::size_t TextTable::column(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw FileError(path + ":1: no column \"" + name + '"');
  return static_cast<std::size_t>(found - names.begin());
}

std::string TextTable::place(std::size_t row) const {
  return path + ":" + std::to_string(row + 2);
}

TextTable read_text_table(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw FileError(path + ": cannot be read");
  std::string line;
  std::getline(in, line);
  TextTable table{path, cells(line), {}};
  while (std::getline(in, line)) {
    table.rows.push_back(cells(line));
    const std::size_t found = table.rows.back().size();
    if (found == table.names.size()) continue;
    throw FileError(table.place(table.rows.size() - 1) + ": " + std::to_string(found) +
                    " values in " + std::to_string(table.names.size()) + " columns");
  }
  return table;
}

}  // namespace suffuse

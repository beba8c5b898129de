#include "tables/sweep_table.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "common/regular_file.hpp"
#include "files/number_text.hpp"
#include "files/table_files.hpp"
#include "tables/table_output.hpp"
#include "values/refusal.hpp"

namespace suffuse {
namespace {

std::size_t position(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

}  // namespace

std::vector<double> SweepTable::numbers(const std::string& column,
                                        const std::string& option) const {
  const std::size_t k = position(names, column);
  if (k == names.size()) {
    refuse("suffuse-post sweep", option, '"' + column + '"',
           "a column of " + path + ": " + quoted_list(names), closest_column(column, names));
  }
  std::vector<double> values;
  for (const auto& row : rows) {
    const auto value = parse_number(row[k]);
    if (!value && !row[k].empty()) {
      refuse("suffuse-post sweep", option, "column \"" + column + "\" with \"" + row[k] + '"',
             "a column of numbers");
    }
    values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return values;
}

std::vector<std::string> SweepTable::results() const {
  const auto folder = std::filesystem::path(path).parent_path();
  const std::size_t run = position(names, "run");
  std::vector<std::string> found;
  for (const auto& row : rows)
    found.push_back((folder / row[run] / (row[run] + ".results")).string());
  return found;
}

SweepTable read_sweep(const std::string& path) {
  std::ifstream in = open_regular_file(path);
  std::string line;
  if (!in.is_open() || !std::getline(in, line)) throw FileError(path + ": cannot be read");
  SweepTable table{path, csv_cells(line), {}};
  const std::size_t status = position(table.names, "status");
  if (status == table.names.size() || position(table.names, "run") == table.names.size()) {
    throw FileError(path + ":1: got no columns run and status; expected the table of a sweep");
  }
  for (int number = 2; std::getline(in, line); ++number) {
    auto cells = csv_cells(line);
    if (cells.size() != table.names.size()) {
      throw FileError(path + ":" + std::to_string(number) + ": got " +
                      std::to_string(cells.size()) + " columns; expected " +
                      std::to_string(table.names.size()));
    }
    if (cells[status] == "done") table.rows.push_back(std::move(cells));
  }
  if (table.rows.empty())
    refuse("suffuse-post sweep", "TABLE", path + " without a run that is done", "one at least");
  return table;
}

}  // namespace suffuse

#include "tables/table_output.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/closest_name.hpp"
#include "common/errors.hpp"

namespace suffuse {
namespace {

std::vector<std::string> time_unit_names() {
  std::vector<std::string> names;
  for (const TimeUnit& unit : time_units()) names.push_back(unit.name);
  return names;
}

template <class Columns>
void add_units(const Columns& columns, std::map<std::string, std::string>& units) {
  for (const auto& [name, member, unit] : columns) units.emplace(name, unit);
}

/// Units by the name of the column: columns with equal names have equal units in all tables.
const std::map<std::string, std::string>& column_units() {
  static const auto all = [] {
    std::map<std::string, std::string> units{{"probe", "1"}, {"section", "1"}, {"region", "1"}};
    add_units(history_columns, units);
    add_units(ledger_columns, units);
    add_units(boundary_columns, units);
    add_units(probe_columns, units);
    add_units(section_columns, units);
    return units;
  }();
  return all;
}

TimeUnit find_time_unit(const std::string& word, const std::string& where, const std::string& key) {
  const auto found = std::ranges::find(time_units(), word, &TimeUnit::name);
  if (found != time_units().end()) return *found;
  throw InputError(InputProblem{where, key, '"' + word + '"', quoted_list(time_unit_names()),
                                closest_name(word, time_unit_names())});
}

/// Whether a quantity of this unit is per metre of thickness in 2D.
bool is_extensive(const std::string& unit) {
  return unit == "kg" || unit == "m3" || unit == "m3/s" || unit == "W" || unit == "J";
}

}  // namespace

TimeUnit parse_time_unit(const std::string& word, const std::string& command) {
  return find_time_unit(word, command, "--time-unit");
}

std::string time_unit_words() {
  std::string words;
  for (const std::string& name : time_unit_names()) words += (words.empty() ? "" : "|") + name;
  return words;
}

std::string column_unit(const std::string& name, int dimension) {
  const auto found = column_units().find(name);
  return found == column_units().end() ? "" : shown_unit(found->second, dimension);
}

std::string closest_column(const std::string& name, const std::vector<std::string>& known) {
  const std::string now = renamed_column(name);
  return std::ranges::find(known, now) != known.end() ? now : closest_name(name, known);
}

std::string shown_unit(const std::string& unit, int dimension) {
  if (unit == "1" || unit.empty()) return "-";
  return dimension == 2 && is_extensive(unit) ? unit + "/m" : unit;
}

double clean_coordinate(double x) {
  return std::abs(x) < 1e-12 ? 0.0 : x;
}

std::string place_text(const std::vector<double>& place) {
  std::string text;
  for (const double x : place) {
    text += (text.empty() ? "(" : ", ") + short_text(clean_coordinate(x));
  }
  return text + ")";
}

std::string alarm_line(const std::string& line, const TextStyle& style) {
  return style.colors ? "\033[1;31m" + line + "\033[0m" : line;
}

std::string padded(const std::string& text, int width) {
  const auto size = static_cast<int>(text.size());
  const std::string gap(std::max(0, std::abs(width) - size), ' ');
  return width < 0 ? text + gap : gap + text;
}

Table with_units(Table table, int dimension, const TimeUnit& time) {
  table.units.resize(table.names.size());
  for (std::size_t k = 0; k < table.names.size(); ++k) {
    if (table.names[k] == "t") {
      for (double& t : table.columns[k]) t /= time.seconds;
      table.units[k] = time.name;
    } else if (table.units[k].empty()) {
      table.units[k] = column_unit(table.names[k], dimension);
    }
  }
  return table;
}

Table with_seconds(Table table, const std::string& path) {
  for (std::size_t k = 0; k < table.units.size(); ++k) {
    if (table.names[k] != "t" || table.units[k].empty()) continue;
    const TimeUnit unit = find_time_unit(table.units[k], path, "t [...]");
    for (double& t : table.columns[k]) t *= unit.seconds;
    table.units[k] = "s";
  }
  return table;
}

std::vector<NamedTable> with_units(std::vector<NamedTable> tables, int dimension,
                                   const TimeUnit& time) {
  for (NamedTable& named : tables) named.table = with_units(named.table, dimension, time);
  return tables;
}

}  // namespace suffuse

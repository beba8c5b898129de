#include "files/element_table.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "scene/scene_schema.hpp"
#include "scene/table_file.hpp"

namespace suffuse {
namespace {

/// Larger strains are probably given in per cent.
constexpr double largest_strain = 2.0;

const std::vector<std::string>& known_columns() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names{"t", "step"};
    for (const std::string kind : {"strain_", "stress_"}) {
      for (const char* component : component_names) names.push_back(kind + component);
    }
    names.emplace_back("fines_left");
    return names;
  }();
  return all;
}

std::vector<std::string> element_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != ' ' && c != '\t' && c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

class ElementTableReader {
 public:
  explicit ElementTableReader(const std::string& path) { table_.path = path; }

  ElementTable read(std::istream& lines) {
    std::string line;
    for (; std::getline(lines, line); ++number_) {
      if (number_ == 1) {
        read_header(line.starts_with("\xEF\xBB\xBF") ? line.substr(3) : line);
        if (!problems_.empty()) break;
      } else if (line.find_first_not_of(" \t\r") != std::string::npos) {
        read_row(element_cells(line), line);
      }
    }
    number_ = std::max(number_, 1);
    if (table_.rows.empty() && problems_.empty()) {
      report("", "no row", "a header line and at least one row, the start");
    }
    if (!problems_.empty()) throw InputError(std::move(problems_));
    return std::move(table_);
  }

 private:
  void report(const std::string& column, const std::string& found, const std::string& expected,
              const std::string& suggestion = {}) {
    problems_.push_back({.where = table_.path + ':' + std::to_string(number_),
                         .key = column,
                         .found = found,
                         .expected = expected,
                         .suggestion = suggestion});
  }

  [[nodiscard]] bool has(const std::string& column) const {
    return std::ranges::count(columns_, column) > 0;
  }

  void read_header(const std::string& line) {
    columns_ = element_cells(line);
    const std::vector<std::string>& known = known_columns();
    for (const std::string& column : columns_) {
      if (!std::ranges::count(known, column)) {
        report("", shown_value(column), "columns " + listed(known, "and") + separator_advice(line),
               closest_name(column, known));
      } else if (std::ranges::count(columns_, column) > 1) {
        report(column, "a column twice", "one column of a name");
        return;
      }
    }
    if (!problems_.empty()) return;
    for (const std::string component : {"xx", "yy", "zz"}) {
      const std::string strain = "strain_" + component;
      const std::string stress = "stress_" + component;
      if (!has(strain) && !has(stress)) {
        report(strain, "no column", listed({strain, stress}) + ", or both");
      }
    }
    if (has("t") && has("step")) report("step", "a column in addition to t", "one of the two");
    table_.moment = has("t") ? "t" : "step";
  }

  void read_row(const std::vector<std::string>& cells, const std::string& line) {
    if (cells.size() != columns_.size()) {
      return report(
          "", std::to_string(cells.size()) + " values",
          std::to_string(columns_.size()) + ", as many as columns" + separator_advice(line));
    }
    const bool first = table_.rows.empty();
    const std::size_t problems = problems_.size();
    ElementTableRow row{.line = number_, .moment = static_cast<double>(table_.rows.size())};
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (cells[k].empty() && (columns_[k].starts_with('s') && columns_[k] != "step")) continue;
      const std::optional<double> value = parse_number(cells[k]);
      if (!value || !std::isfinite(*value)) {
        report(columns_[k], cells[k].empty() ? "nothing" : shown_value(cells[k]), "a number");
        continue;
      }
      keep(columns_[k], *value, row);
    }
    if (problems_.size() == problems) check_controls(row, first);
    if (!first && has(table_.moment) && row.moment <= table_.rows.back().moment) {
      report(table_.moment, shown_number(row.moment),
             "more than " + shown_number(table_.rows.back().moment) + ", of the row before");
    }
    table_.rows.push_back(row);
  }

  void keep(const std::string& column, double value, ElementTableRow& row) {
    if (column == table_.moment) {
      row.moment = value;
    } else if (column == "fines_left") {
      row.fines_left = value;
      if (value >= 0.0 && value <= 1.0) return;
      report(column, shown_number(value), "a share of the erodible fines, 0 to 1");
    } else {
      const std::size_t c =
          std::ranges::find(component_names, column.substr(7)) - component_names.begin();
      const bool is_stress = column.starts_with("stress");
      (is_stress ? row.stress : row.strain)[c] = value;
      if (is_stress || std::abs(value) <= largest_strain) return;
      report(column, shown_number(value),
             "a logarithmic strain between -2 and 2: -0.1 is a tenth, in compression");
    }
  }

  void check_controls(const ElementTableRow& row, bool first) {
    for (std::size_t c = 0; c < component_names.size(); ++c) {
      const std::string component = component_names[c];
      const std::string strain = "strain_" + component;
      const std::string stress = "stress_" + component;
      if (first) {
        if (row.strain[c].value_or(0.0) == 0.0) continue;
        report(strain, shown_number(*row.strain[c]),
               "0 or nothing in the first row, which is the start");
      } else if (row.strain[c] && row.stress[c]) {
        report(stress, "a value in addition to that of " + strain, "one of the two");
      } else if (!row.strain[c] && !row.stress[c] && (has(strain) || has(stress))) {
        report(has(strain) ? strain : stress, "nothing", "a value, of a strain or a stress");
      }
    }
  }

  ElementTable table_;
  std::vector<std::string> columns_;
  std::vector<InputProblem> problems_;
  int number_ = 1;
};

}  // namespace

ElementTable read_element_table(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file || file.bad()) throw FileError(path + ": cannot be read");
  std::istringstream lines(text.str());
  return ElementTableReader(path).read(lines);
}

}  // namespace suffuse

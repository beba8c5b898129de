#include "files/table_files.hpp"

#include <algorithm>
#include <iterator>

#include "files/layout.hpp"
#include "files/number_text.hpp"

namespace suffuse {
namespace {

template <class Columns>
std::string names_of(const Columns& columns) {
  std::string line;
  for (const auto& [name, member, unit] : columns) {
    if (!line.empty()) line += ',';
    line += name;
  }
  return line;
}

template <class Row, class Columns>
std::string values_of(const Row& row, const Columns& columns) {
  std::string line;
  for (const auto& [name, member, unit] : columns) {
    if (!line.empty()) line += ',';
    line += number_text(row.*member);
  }
  return line;
}

/// Inserts `cells` after the first cell of `line`.
std::string with_second(std::string line, const std::string& cells) {
  return line.insert(line.find(','), ',' + cells);
}

}  // namespace

std::vector<std::string> booked_boundaries(const Scene& scene) {
  std::vector<std::string> names;
  for (const BoundaryCondition& boundary : scene.boundaries) names.push_back(boundary.on);
  for (const Wall& wall : scene.walls) {
    if (wall.conductance > 0.0) names.push_back(wall.on);
  }
  return names;
}

std::vector<TableFile> table_files(const Scene& scene, std::size_t regions) {
  std::vector<TableFile> files{
      {layout::history, names_of(history_columns), 1},
      {layout::ledger, names_of(ledger_columns), 1},
      {layout::regions, with_second(names_of(ledger_columns), "region,porosity_mean"),
       static_cast<long>(regions)},
      {layout::boundaries, with_second(names_of(boundary_columns), "boundary"),
       static_cast<long>(booked_boundaries(scene).size())}};
  if (!scene.output.probes.empty()) {
    files.push_back({layout::probes, names_of(probe_columns), std::ssize(scene.output.probes)});
  }
  if (!scene.output.sections.empty()) {
    files.push_back(
        {layout::sections, names_of(section_columns), std::ssize(scene.output.sections)});
  }
  return files;
}

std::string table_line(const HistoryRow& row) {
  return values_of(row, history_columns) + "\n";
}

std::string table_line(const LedgerRow& row) {
  return values_of(row, ledger_columns) + "\n";
}

std::string table_line(const RegionRow& row) {
  return with_second(values_of(row.ledger, ledger_columns),
                     std::to_string(row.region) + ',' + number_text(row.porosity_mean)) +
         "\n";
}

std::string table_line(const BoundaryRow& row) {
  return with_second(values_of(row, boundary_columns), csv_cell(row.boundary)) + "\n";
}

std::string table_line(const ProbeRow& row) {
  return values_of(row, probe_columns) + "\n";
}

std::string table_line(const SectionRow& row) {
  return values_of(row, section_columns) + "\n";
}

std::string csv_cell(std::string text) {
  // Each row of the table must be one line of the file.
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) {
    if (c == '"') cell += '"';
    cell += c;
  }
  return cell + '"';
}

std::vector<std::string> csv_cells(std::string line) {
  if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
  if (line.ends_with('\r')) line.pop_back();
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool is_quote = line[i] == '"';
    if (is_quote && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (is_quote && (quoted || cells.back().empty())) {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += line[i];
    }
  }
  return cells;
}

}  // namespace suffuse

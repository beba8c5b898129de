#include "report/first_page.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "files/table_files.hpp"
#include "files/time_unit.hpp"
#include "report/html.hpp"
#include "report/report_pictures.hpp"
#include "tables/discharge_text.hpp"

namespace suffuse {
namespace {

html::Cell optional_cell(double value) {
  return std::isnan(value) ? html::cell("-") : html::cell(value);
}

html::Cell time_cell(double seconds, const TimeUnit& unit) {
  return std::isnan(seconds) ? html::cell("-") : html::cell(seconds, time_text(seconds, unit));
}

std::string mechanisms_html(const RunNumbers& numbers) {
  if (!numbers.checks) {
    return html::element(
        "p", "The checks of standards could not be made: " + numbers.checks_refused + ".");
  }
  const TimeUnit unit = fitting_time_unit(numbers.end);
  html::Table table{"mechanisms",
                    {"mechanism", "where", "limit", "factor [-]", "effect", "resistance", "unit",
                     "at t", "first below 1", "at [m]", "by"},
                    {}};
  std::vector<std::string> notes;
  for (const CheckRow& row : exceeded_first(numbers.checks->rows)) {
    if (row.fails()) table.exceeded.insert(table.rows.size());
    table.rows.push_back(
        {html::cell(row.mechanism), html::cell(row.where), html::cell(limit_word(row)),
         row.factor ? html::cell(*row.factor) : html::cell("-"), optional_cell(row.effect),
         optional_cell(row.resistance), html::cell(row.unit.empty() ? "-" : row.unit),
         time_cell(row.time, unit), time_cell(row.first_below, unit),
         html::cell(row.place.empty() ? "-" : place_text(row.place)), html::cell(row.clause)});
    if (!row.note.empty())
      notes.push_back(row.mechanism + ", " + row.where + ": " + row.note + ".");
  }
  return html::element("p",
                       "Factor: resistance over effect, with the partial factors of the clause. A "
                       "limit is exceeded below 1. Each row is the worst of all snapshots, "
                       "and has the time of the first whose factor is below 1.") +
         table.html() + (notes.empty() ? "" : html::list(notes));
}

std::string accuracy_html(const ResultsReader& run) {
  const std::string known = discharge_text(run);
  return html::element(
      "p",
      known.empty()
          ? "The error of the mesh is not known: the scene has no mesh.error, such as "
            "mesh.error = 0.02. A study of convergence (make convergence) or mesh.error gives it."
          : known + ".");
}

std::string gaps_html(const RunNumbers& numbers) {
  if (!numbers.checks) return "";
  std::vector<std::string> gaps = numbers.checks->unseen_peaks;
  for (const std::string& sentence : numbers.checks->not_looked_at) gaps.push_back(sentence);
  for (const std::string& message : numbers.checks->refused)
    gaps.push_back("not possible: " + message);
  return html::list(gaps);
}

/// A chart of a table with the columns `t` and `factor`, such as that of --strength-reduction.
std::string factors_of(const ResultsReader& run, const html::Table& table) {
  const auto column = [&](const std::string& name) {
    return std::ranges::find(table.heads, name) - table.heads.begin();
  };
  const auto t = static_cast<std::size_t>(column("t"));
  const auto factor = static_cast<std::size_t>(column("factor"));
  if (std::max(t, factor) >= table.heads.size()) return "";
  std::vector<double> times;
  std::vector<double> factors;
  for (const auto& row : table.rows) {
    if (!row[t].value || !row[factor].value || !std::isfinite(*row[factor].value)) continue;
    times.push_back(*row[t].value);
    factors.push_back(*row[factor].value);
  }
  return times.size() < 2 ? "" : factor_html(run, times, factors);
}

}  // namespace

std::string first_page(const ResultsReader& run, const RunNumbers& numbers) {
  return "<p class=\"summary\">" + html::escaped(summary_text(run, numbers)) + "</p>\n" +
         html::element("h3", "Mechanisms") + mechanisms_html(numbers) +
         html::element("h3", "How sure") + accuracy_html(run) +
         html::element("h3", "Not looked at") + gaps_html(numbers);
}

std::string table_file_html(const ResultsReader& run, const std::string& path) {
  std::ifstream in(path);
  if (!in || !std::filesystem::is_regular_file(path)) throw FileError(path + ": cannot be read");
  std::string line;
  html::Table table{"added", {}, {}};
  for (int number = 1; std::getline(in, line); ++number) {
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() == 1 && cells[0].empty()) continue;
    if (table.heads.empty()) {
      table.heads = cells;
      continue;
    }
    if (cells.size() != table.heads.size()) {
      throw InputError(
          InputProblem{path + ":" + std::to_string(number), "--table",
                       std::to_string(cells.size()) + (cells.size() == 1 ? " cell" : " cells"),
                       std::to_string(table.heads.size()) + ", one for each name"});
    }
    auto& row = table.rows.emplace_back();
    for (const std::string& text : cells) {
      const auto value = parse_number(text);
      row.push_back(value ? html::cell(*value) : html::cell(text.empty() ? "-" : text));
    }
  }
  if (table.heads.empty()) {
    throw InputError(
        InputProblem{path, "--table", "an empty file", "a CSV table with a line of names"});
  }
  return html::element("h3", std::filesystem::path(path).stem().string()) + table.html() +
         factors_of(run, table);
}

}  // namespace suffuse

#include "checks/checks.hpp"

#include <algorithm>
#include <cmath>

#include "checks/column_checks.hpp"
#include "checks/erosion_checks.hpp"
#include "checks/filter_checks.hpp"
#include "checks/heave_safety.hpp"
#include "checks/section_checks.hpp"
#include "checks/unseen_peaks.hpp"
#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "files/table_files.hpp"
#include "files/text_output.hpp"
#include "tables/table_output.hpp"
#include "values/snapshot_choice.hpp"

namespace suffuse {
namespace {

/// Rows of `heave` at the boundaries through which water leaves.
std::vector<CheckRow> heave_checks(const ResultsReader& results) {
  std::vector<CheckRow> rows;
  const auto parts = safety_of(results);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (!parts[i].least) continue;
    const LeastSafety& least = *parts[i].least;
    rows.push_back({"heave", parts[i].name, "Terzaghi, i_cr / i", least.time, least.gradient,
                    least.critical_gradient, "1", least.safety, least.place});
    rows.back().first_below = parts[i].first_below.value_or(unset);
  }
  return rows;
}

/// Mechanisms that a report lacks, by phase.
class Gaps {
 public:
  Gaps(const ResultsReader& results, const CheckReport& report, const CheckSettings& settings)
      : scene_(results.scene().scene), rows_(report.rows), settings_(settings) {}

  [[nodiscard]] std::vector<std::string> sentences() const {
    return {"initiation: " + initiation(), "continuation: " + continuation(),
            "progression: " + progression(),
            "breach: the slope (suffuse-solver --strength-reduction), overtopping, the breach "
            "itself"};
  }

 private:
  [[nodiscard]] bool has(const std::string& mechanism) const {
    return std::ranges::any_of(rows_,
                               [&](const CheckRow& row) { return row.mechanism == mechanism; });
  }

  [[nodiscard]] std::string initiation() const {
    std::string text = "concentrated leaks through cracks, contact erosion along joints";
    if (!has("erosion")) text += ", suffusion (no soil erodes)";
    if (!has("internal-stability")) text += ", internal stability (key soil.NAME.gradation)";
    if (!has("heave")) text += ", heave (water rises at no boundary that it leaves through)";
    if (!has("hyd-forces")) text += ", " + heave_by_forces();
    if (!has("uplift")) text += ", " + uplift();
    if (!has("blanket")) text += ", blanket theory (key check.blanket.aquifer)";
    return text;
  }
  [[nodiscard]] std::string heave_by_forces() const {
    if (scene_.moves()) return "heave by EN 1997-1 (the soil moves)";
    return std::string("heave by EN 1997-1") + (has("hyd-stresses") ? ", 2.9b" : "") +
           " (water leaves through no ground)";
  }
  [[nodiscard]] std::string uplift() const {
    const std::string& cover = settings_.uplift.cover;
    if (cover.empty()) return "uplift of a cover (key check.uplift.cover)";
    return "uplift of \"" + cover + "\" (" +
           (scene_.moves() ? "the soil moves)"
                           : "it is nowhere the ground with water pressing below it)");
  }
  [[nodiscard]] std::string continuation() const {
    return has("filter")
               ? "filters between soils without a gradation"
               : "filters (no two soils with a gradation, key soil.NAME.gradation, and flow "
                 "between them)";
  }
  [[nodiscard]] std::string progression() const {
    return has("backward-erosion") ? "pipes elsewhere than in the layer that was checked"
                                   : "backward erosion (key check.backward_erosion.layer)";
  }

  const Scene& scene_;
  const std::vector<CheckRow>& rows_;
  const CheckSettings& settings_;
};

std::string rounded_cell(double value) {
  return std::isnan(value) ? "-" : short_text(value);
}

std::string exact_cell(double value) {
  return std::isnan(value) ? "" : number_text(value);
}

/// Columns of the text: the first two aligned to the left.
std::vector<std::string> text_cells(const CheckRow& row, const TimeUnit& unit) {
  const auto with_unit = [&](double value) {
    return rounded_cell(value) +
           (std::isnan(value) || row.unit == "1" || row.unit.empty() ? "" : " " + row.unit);
  };
  return {row.mechanism,
          row.where,
          row.factor ? short_text(*row.factor) : "-",
          limit_word(row),
          with_unit(row.effect),
          with_unit(row.resistance),
          std::isnan(row.time) ? "-" : time_digits(row.time, unit),
          row.place.empty() ? "-" : place_text(row.place),
          row.clause};
}

/// The lines with their cells in columns.
std::vector<std::string> aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> width(lines.front().size(), 0);
  for (const auto& line : lines) {
    for (std::size_t k = 0; k < line.size(); ++k) width[k] = std::max(width[k], line[k].size());
  }
  std::vector<std::string> texts;
  for (const auto& line : lines) {
    std::string& text = texts.emplace_back();
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const int columns = static_cast<int>(width[k]);
      text += padded(line[k], k < 2 ? -columns : columns) + "  ";
    }
    text += line.back();
  }
  return texts;
}

/// Sentences about a row: since when its factor is below 1, and its note.
std::string sentences_of(const CheckRow& row, const TimeUnit& unit) {
  const std::string start = row.mechanism + ", " + row.where + ": ";
  std::string text;
  if (!std::isnan(row.first_below)) {
    text += start + "the factor is below 1 for the first time at t = " +
            time_digits(row.first_below, unit) + " " + unit.name + "\n";
  }
  if (!row.note.empty()) text += start + row.note + "\n";
  return text;
}

}  // namespace

CheckSettings check_settings(const ResultsReader& results,
                             const std::vector<std::string>& changes) {
  const SceneDocument& document = results.scene();
  if (changes.empty()) return document.scene.check;
  std::vector<std::string> overrides = document.overrides;
  for (const std::string& change : changes) {
    if (!change.starts_with("check.")) {
      throw InputError(InputProblem{"suffuse-post check", "--set", '"' + change + '"',
                                    "check.KEY=VALUE, with a key of the table [check]"});
    }
    overrides.push_back(change);
  }
  return parse_scene(document.text, document.path, overrides, document.files).scene.check;
}

CheckReport check_run(const ResultsReader& results, const CheckSettings& settings) {
  CheckReport report;
  // One check that cannot be made does not hide the others.
  const auto add = [&](const auto& check) {
    try {
      const std::vector<CheckRow> rows = check();
      report.rows.insert(report.rows.end(), rows.begin(), rows.end());
    } catch (const InputError& error) {
      report.refused.emplace_back(error.what());
    }
  };
  expect_snapshots(results);
  add([&] { return threshold_checks(results); });
  add([&] { return loss_checks(results); });
  add([&] { return heave_checks(results); });
  add([&] { return column_checks(results, settings); });
  add([&] { return blanket_checks(results, settings.blanket); });
  add([&] { return stability_checks(results); });
  add([&] { return filter_checks(results); });
  add([&] { return backward_erosion_checks(results, settings.backward_erosion); });
  report.unseen_peaks = unseen_peaks(results);
  report.not_looked_at = Gaps(results, report, settings).sentences();
  return report;
}

std::vector<CheckRow> exceeded_first(std::vector<CheckRow> rows) {
  std::stable_partition(rows.begin(), rows.end(), [](const CheckRow& row) { return row.fails(); });
  return rows;
}

std::string limit_word(const CheckRow& row) {
  if (!row.factor) return "-";
  return row.fails() ? "EXCEEDED" : "kept";
}

std::string check_text(const CheckReport& report, const TextStyle& style) {
  const std::vector<CheckRow> rows = exceeded_first(report.rows);
  std::vector<std::vector<std::string>> cells{{"mechanism", "where", "factor", "limit", "effect",
                                               "resistance", "t (" + style.time.name + ")",
                                               "at (m)", "by"}};
  for (const CheckRow& row : rows) cells.push_back(text_cells(row, style.time));
  const std::vector<std::string> lines = aligned(cells);
  std::string text =
      "factor = resistance / effect, partial factors included; below 1 the limit is exceeded\n" +
      lines.front() + "\n";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    text += (rows[k].fails() ? alarm_line(lines[k + 1], style) : lines[k + 1]) + "\n";
  }
  for (const CheckRow& row : rows) text += sentences_of(row, style.time);
  text += "not looked at:\n";
  for (const std::string& sentence : report.unseen_peaks) text += "  " + sentence + "\n";
  for (const std::string& sentence : report.not_looked_at) text += "  " + sentence + "\n";
  for (const std::string& message : report.refused) text += "  not possible: " + message + "\n";
  return text;
}

std::string check_table(const CheckReport& report, int dimension,
                        const std::optional<TimeUnit>& unit) {
  const std::string z = dimension == 3 ? ",z" : "";
  const std::string of_time = unit ? " [" + unit->name + "]" : "";
  const double seconds = unit.value_or(TimeUnit{}).seconds;
  std::string text = "mechanism,where,clause,t" + of_time + ",effect,resistance,unit,factor,x,y" +
                     z + ",note,t_below_1" + of_time + "\n";
  for (const CheckRow& row : report.rows) {
    std::vector<std::string> cells{row.mechanism,
                                   row.where,
                                   row.clause,
                                   exact_cell(row.time / seconds),
                                   exact_cell(row.effect),
                                   exact_cell(row.resistance),
                                   row.unit,
                                   row.factor ? number_text(*row.factor) : ""};
    for (int d = 0; d < dimension; ++d) {
      cells.push_back(row.place.empty() ? "" : number_text(clean_coordinate(row.place[d])));
    }
    cells.push_back(row.note);
    cells.push_back(exact_cell(row.first_below / seconds));
    for (std::size_t k = 0; k < cells.size(); ++k) text += (k == 0 ? "" : ",") + csv_cell(cells[k]);
    text += "\n";
  }
  return text;
}

void write_checks(const std::string& path, const CheckReport& report, int dimension,
                  const std::optional<TimeUnit>& unit) {
  TextOutput(path).write(check_table(report, dimension, unit));
}

void require_all_checks(const CheckReport& report) {
  if (report.refused.empty()) return;
  std::string messages;
  for (const std::string& message : report.refused) {
    messages += (messages.empty() ? "" : "\n") + message;
  }
  throw InputError(messages);
}

void require_limit_states(const CheckReport& report) {
  for (const CheckRow& row : report.rows) {
    if (!row.factor || *row.factor >= 1.0) continue;
    throw NumericalError(row.mechanism + ", " + row.where + ": got a factor of " +
                         number_text(*row.factor) +
                         (row.place.empty() ? "" : " at " + place_text(row.place) + " m") +
                         (std::isnan(row.time) ? "" : ", t = " + number_text(row.time) + " s") +
                         "; expected at least 1");
  }
}

}  // namespace suffuse

#include "figures/table_curves.hpp"

#include <algorithm>
#include <map>

#include "common/closest_name.hpp"
#include "common/errors.hpp"
#include "figures/axes.hpp"
#include "figures/measured.hpp"
#include "figures/run_curves.hpp"
#include "tables/table_output.hpp"
#include "values/name_words.hpp"
#include "values/outside_water.hpp"
#include "values/refusal.hpp"

namespace suffuse {
namespace {

const std::string curves_command = "suffuse-post figure curves";

/// The parts of a table that share a value of its column `by`, which gets that value as a name.
std::vector<NamedTable> parts_of(const Table& table, const std::string& by,
                                 const std::vector<std::string>& names) {
  std::vector<NamedTable> parts;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto number = static_cast<std::size_t>(table.column(by)[row]);
    const std::string name = number < names.size() ? names[number] : std::to_string(number);
    auto part = std::ranges::find(parts, name, &NamedTable::name);
    if (part == parts.end()) {
      part = parts.insert(part, {name, table});
      for (auto& column : part->table.columns) column.clear();
    }
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      part->table.columns[k].push_back(table.columns[k][row]);
    }
  }
  return parts;
}

/// The tables of a run by their names, without those that the scene does not ask for.
std::vector<NamedTable> read_parts(const ResultsReader& run, const std::string& table) {
  const OutputSettings& output = run.scene().scene.output;
  if (table == "history") return {{"", run.history()}};
  if (table == "ledger") return {{"", run.ledger()}};
  if (table == "boundaries") return run.boundaries();
  if (table == "regions") return parts_of(run.region_ledgers(), "region", run.regions());
  if (table == "probes" && !output.probes.empty()) return parts_of(run.probes(), "probe", {});
  if (table == "sections" && !output.sections.empty()) {
    return parts_of(run.sections(), "section", {});
  }
  return {};
}

const std::vector<std::string> table_names{"history",    "ledger", "regions",
                                           "boundaries", "probes", "sections"};

/// TABLE.COLUMN:NAME in its parts.
struct ColumnName {
  std::string text;
  std::string table;  ///< may be empty
  std::string column;
  std::string part;  ///< may be empty
};

ColumnName parse_column(const std::string& text) {
  ColumnName name{text, "", text, ""};
  const auto colon = name.column.find(':');
  if (colon != std::string::npos) {
    name.part = name.column.substr(colon + 1);
    name.column.resize(colon);
  }
  const auto dot = name.column.find('.');
  if (dot == std::string::npos) return name;
  name.table = name.column.substr(0, dot);
  name.column.erase(0, dot + 1);
  if (std::ranges::find(table_names, name.table) == table_names.end()) {
    refuse(curves_command, "COLUMN", '"' + text + '"', "a table out of " + quoted_list(table_names),
           closest_name(name.table, table_names));
  }
  return name;
}

/// What figures call a part of a table.
std::string label_of_part(const ResultsReader& run, const std::string& table,
                          const std::string& part) {
  if (table == "sections") return "section " + part;
  if (table != "probes") return part;
  const OutputProbe& probe = run.scene().scene.output.probes[std::stoul(part)];
  return "probe " + part + " at " +
         place_text({probe.at.begin(), probe.at.begin() + run.dimension()});
}

/// A table that only scenes with a list of its own have.
struct ListTable {
  std::string name;
  std::vector<std::string> columns;
  std::string key;
  std::string example;
};

const std::vector<ListTable>& list_tables() {
  const auto names_of = [](const auto& columns) {
    std::vector<std::string> names;
    names.reserve(columns.size());
    for (const auto& column : columns) names.emplace_back(column.name);
    return names;
  };
  static const std::vector<ListTable> tables{
      {"probes", names_of(probe_columns), "[[output.probe]]", "at = [0.5, 0.5]"},
      {"sections", names_of(section_columns), "[[output.section]]",
       "from = [0.0, 0.5] and to = [1.0, 0.5]"}};
  return tables;
}

/// Throws InputError if the column is of a table that the scene has no list for.
void refuse_missing_list(const ResultsReader& run, const ColumnName& name) {
  for (const ListTable& table : list_tables()) {
    const bool is_meant = name.table.empty()
                              ? std::ranges::find(table.columns, name.column) != table.columns.end()
                              : name.table == table.name;
    if (!is_meant || !read_parts(run, table.name).empty()) continue;
    refuse(curves_command, "COLUMN", '"' + name.text + "\" of " + run.folder(),
           missing_key(table.key, table.example));
  }
}

/// The parts of the first table of a run that has the column, and the table's name.
std::pair<std::string, std::vector<NamedTable>> find_parts(const ResultsReader& run,
                                                           const ColumnName& name) {
  std::vector<std::string> known;
  for (const std::string& table : table_names) {
    if (!name.table.empty() && table != name.table) continue;
    std::vector<NamedTable> parts = read_parts(run, table);
    if (parts.empty()) continue;
    if (parts.front().table.has(name.column)) return {table, parts};
    for (const std::string& column : parts.front().table.names) {
      if (std::ranges::find(known, column) == known.end()) known.push_back(column);
    }
  }
  refuse_missing_list(run, name);
  refuse(curves_command, "COLUMN", '"' + name.text + '"',
         known.empty() ? "a table that " + run.folder() + " has" : quoted_list(known),
         closest_column(name.column, known));
}

/// Removes boundaries without a head outside, for which tables have the level 0.
void remove_missing_levels(const ResultsReader& run, const std::string& column,
                           std::vector<NamedTable>& parts) {
  std::erase_if(parts,
                [&](const NamedTable& part) { return !has_level(run.scene().scene, part.name); });
  if (!parts.empty()) return;
  refuse(curves_command, "COLUMN", '"' + column + "\" of a run without a head at its boundaries",
         missing_key("head of a [[boundary]]", "head = 2.0"));
}

std::vector<NamedTable> wanted(std::vector<NamedTable> parts, const ColumnName& name) {
  if (name.part.empty()) return parts;
  std::vector<std::string> known;
  for (const NamedTable& part : parts) {
    if (part.name == name.part) return {part};
    known.push_back(part.name);
  }
  refuse(curves_command, "COLUMN", '"' + name.text + '"',
         "behind the colon one of " + quoted_list(known), closest_name(name.part, known));
}

std::string label_of(const std::string& column, int dimension) {
  const std::string unit = column_unit(column, dimension);
  return column_words(column) + (unit.empty() ? "" : " (" + unit + ")");
}

/// The run, if there are several, and the part of the table.
std::string label_of(const std::vector<std::string>& runs, std::size_t run,
                     const std::string& part) {
  if (runs.size() == 1) return part;
  return part.empty() ? runs[run] : runs[run] + ": " + part;
}

/// Removes the rows in which a ratio has no value, for which tables have 0.
void remove_missing(Curve& curve, const std::string& column) {
  if (column != "conductivity_ratio") return;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < curve.y.size(); ++k) {
    if (curve.y[k] == 0.0) continue;
    curve.x[kept] = curve.x[k];
    curve.y[kept++] = curve.y[k];
  }
  curve.x.resize(kept);
  curve.y.resize(kept);
}

Curve table_curve(const Table& table, const std::string& x, const std::string& y,
                  std::size_t number) {
  constexpr std::array<Dash, 5> dashes{Dash::solid, Dash::dashed, Dash::dash_dot, Dash::dotted,
                                       Dash::dash_dot_dot};
  Curve curve;
  curve.x = table.column(x);
  curve.y = table.column(y);
  curve.color = curve_style(number).color;
  curve.dash = dashes.at(number % dashes.size());
  return curve;
}

/// Numbers of styles by label: charts share a legend, so one label has one style in all of them.
class LabelStyles {
 public:
  std::size_t number(const std::string& label) {
    const auto found = std::ranges::find(labels_, label);
    const auto number = static_cast<std::size_t>(found - labels_.begin());
    if (found == labels_.end()) labels_.push_back(label);
    return number;
  }

 private:
  std::vector<std::string> labels_;
};

Chart chart_of(const std::vector<ResultsReader>& runs, const std::vector<std::string>& labels,
               const ColumnName& name, const std::string& x, LabelStyles& styles) {
  const int dimension = runs.front().dimension();
  Chart chart{capitalized(column_words(name.column)) + (name.part.empty() ? "" : ": " + name.part),
              x == "t" ? seconds_label : label_of(x, dimension),
              label_of(name.column, dimension),
              {}};
  for (std::size_t r = 0; r < runs.size(); ++r) {
    auto [table, parts] = find_parts(runs[r], name);
    if (table == "boundaries" && (name.column == "level" || x == "level")) {
      remove_missing_levels(runs[r], name.text, parts);
    }
    for (const NamedTable& part : wanted(parts, name)) {
      if (!part.table.has(x)) {
        refuse(curves_command, "--x", '"' + x + '"', quoted_list(part.table.names),
               closest_column(x, part.table.names));
      }
      require_curve(runs[r], part.table, name.text);
      const std::string label =
          label_of(labels, r, name.part.empty() ? label_of_part(runs[r], table, part.name) : "");
      Curve curve = table_curve(part.table, x, name.column, styles.number(label));
      remove_missing(curve, name.column);
      curve.label = label;
      chart.curves.push_back(std::move(curve));
    }
  }
  return chart;
}

}  // namespace

std::vector<Chart> table_curves(const std::vector<ResultsReader>& runs,
                                const FigureOptions& options) {
  if (options.columns.empty()) {
    refuse(curves_command, "COLUMN", "none",
           "a column of a table, such as \"flux_out\", before the results");
  }
  const std::vector<std::string> labels = run_labels(runs);
  const std::string x = options.x.empty() ? "t" : options.x;
  MeasuredPoints measured;
  if (!options.measured.empty()) measured = read_measured(options.measured);
  std::vector<Chart> charts;
  LabelStyles styles;
  for (const std::string& text : options.columns) {
    const ColumnName name = parse_column(text);
    charts.push_back(chart_of(runs, labels, name, x, styles));
    add_measured(measured, x, name.column, labels, charts.back());
  }
  if (!options.measured.empty() && std::ranges::none_of(charts, [](const Chart& chart) {
        return std::ranges::any_of(chart.curves, &Curve::markers);
      })) {
    refuse(curves_command, "--measured", options.measured,
           "columns " + x + " and one of " + quoted_list(options.columns));
  }
  return charts;
}

}  // namespace suffuse

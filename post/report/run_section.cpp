#include "report/run_section.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "files/number_text.hpp"
#include "report/html.hpp"
#include "report/report_pictures.hpp"
#include "tables/discharge_text.hpp"
#include "values/outside_water.hpp"
#include "values/run_names.hpp"

namespace suffuse {
namespace {

using html::Cell;

std::string heading(const std::string& id, const std::string& part, const std::string& title) {
  return "<h3 id=\"" + id + "-" + part + "\">" + html::escaped(title) + "</h3>\n";
}

std::string with_unit(const std::string& name, const std::string& unit, int dimension) {
  return name + " [" + shown_unit(unit, dimension) + "]";
}

std::string scene_html(const ResultsReader& run) {
  const SceneDocument& scene = run.scene();
  std::string text = "<pre>" + html::escaped(scene.text) + "</pre>\n";
  for (const std::string& change : scene.overrides) text += html::element("p", "--set " + change);
  for (const auto& [name, content] : scene.files) {
    text += html::folded(name, "<pre>" + html::escaped(content) + "</pre>\n");
  }
  return html::folded("Scene " + scene.path, text);
}

std::string plan_html(const RunRecord& record) {
  const RunInfo& info = record.info;
  std::string text = info.warnings.empty()
                         ? html::element("p", "No warnings.")
                         : html::element("p", "Warnings:") + html::list(info.warnings);
  text += html::element("p", "What ran, and what was skipped:") + html::list(info.plan);
  html::Table passes{"passes", {"pass", "calls", "time [s]"}, {}};
  for (const PassTiming& pass : info.passes) {
    passes.rows.push_back({html::cell(pass.name), html::cell(static_cast<double>(pass.calls)),
                           html::cell(pass.seconds)});
  }
  return text + html::folded("Where the time went: " + duration_text(info.wall_seconds) + " on " +
                                 std::to_string(info.threads) +
                                 (info.threads == 1 ? " thread" : " threads"),
                             passes.html());
}

std::string ledger_html(const ResultsReader& run, const RunNumbers& numbers) {
  if (numbers.balances.empty()) return html::element("p", "The ledger has no rows yet.");
  html::Table table{"ledger", {"place", "of"}, {}};
  for (const char* name : {"initial", "in", "out", "stored", "eroded", "deposited"}) {
    table.heads.push_back(with_unit(name, "kg", run.dimension()));
  }
  table.heads.insert(table.heads.end(), {"largest residual [-]", "at t [s]"});
  for (const Balance& b : numbers.balances) {
    const bool is_water = b.constituent == "water";
    table.rows.push_back(
        {html::cell(b.place), html::cell(b.constituent), html::cell(b.initial), html::cell(b.in),
         html::cell(b.out), html::cell(b.stored), is_water ? html::cell("-") : html::cell(b.eroded),
         is_water ? html::cell("-") : html::cell(b.deposited),
         html::cell(b.worst_residual, short_text(b.worst_residual)), html::cell(b.worst_time)});
  }
  return table.html();
}

/// Columns that most runs do not have.
bool is_optional(std::string_view column) {
  return column == "level" || column.starts_with("discharge_");
}

/// Whether a column is 0 at the end in every table.
bool is_nothing(const std::vector<NamedTable>& tables, std::string_view column) {
  return std::ranges::all_of(tables, [&](const NamedTable& part) {
    if (!part.table.has(std::string(column))) return true;  // of an earlier version
    return part.table.column(std::string(column)).back() == 0.0;
  });
}

std::string boundaries_html(const ResultsReader& run) {
  const std::vector<NamedTable> boundaries = run.boundaries();
  if (boundaries.empty()) return html::element("p", "No boundary has rows yet.");
  html::Table table{"boundaries", {"boundary"}, {}};
  for (const NamedTable& boundary : boundaries) {
    table.rows.emplace_back(std::vector{html::cell(boundary.name)});
  }
  for (const auto& [name, member, unit] : boundary_columns) {
    const bool is_left_out = name == "t" || (is_optional(name) && is_nothing(boundaries, name));
    if (is_left_out) continue;
    table.heads.push_back(with_unit(std::string(name), std::string(unit), run.dimension()));
    for (std::size_t b = 0; b < boundaries.size(); ++b) {
      const bool is_given = name != "level" || has_level(run.scene().scene, boundaries[b].name);
      const double last = boundaries[b].table.column(std::string(name)).back();
      table.rows[b].push_back(is_given ? html::cell(last) : html::cell("-"));
    }
  }
  const std::string known = discharge_text(run);
  return html::element("p", "Since the start; discharge: out minus in, at the end.") +
         (known.empty() ? "" : html::element("p", known + ".")) + table.html();
}

std::string history_html(const ResultsReader& run) {
  const Table history = run.history();
  if (history.rows() == 0) return "";
  html::Table table{"history", {"column", "first", "last", "least", "largest"}, {}};
  for (std::size_t k = 0; k < history.names.size(); ++k) {
    const auto& values = history.columns[k];
    const auto [low, high] = std::ranges::minmax(values);
    const std::string name = history.names[k];
    table.rows.push_back({html::cell(name + " [" + column_unit(name, run.dimension()) + "]"),
                          html::cell(values.front()), html::cell(values.back()), html::cell(low),
                          html::cell(high)});
  }
  return html::folded("Range of every column of the history", table.html());
}

std::string safety_html(const ResultsReader& run, const RunNumbers& numbers) {
  if (numbers.safety.empty()) {
    return html::element("p", "These results have no hydraulic gradient.");
  }
  html::Table table{
      "safety",
      {"part", "least safety [-]", "gradient i [-]", "critical gradient [-]", "t [s]",
       "first below 1 [s]", "at [m]", with_unit("discharge", "m3/s", run.dimension())},
      {}};
  for (const PartSafety& part : numbers.safety) {
    if (part.first_below) table.exceeded.insert(table.rows.size());
    auto& row = table.rows.emplace_back(std::vector{html::cell(part.name)});
    if (part.least) {
      const LeastSafety& least = *part.least;
      for (const double value :
           {least.safety, least.gradient, least.critical_gradient, least.time}) {
        row.push_back(html::cell(value));
      }
      row.push_back(part.first_below ? html::cell(*part.first_below) : html::cell("-"));
      row.push_back(html::cell(place_text(least.place)));
    } else {
      row.insert(row.end(), 5, html::cell("-"));
      row.push_back(html::cell("water rises nowhere"));
    }
    row.push_back(part.discharge ? html::cell(*part.discharge) : html::cell("-"));
  }
  return html::element("p",
                       "Safety i_cr / i against heave; i: hydraulic gradient upwards, "
                       "i_cr = (1 - n) (rho_s / rho_w - 1).") +
         table.html();
}

std::string commands(const ResultsReader& run) {
  const std::string stem = folder_name(run);
  const std::string case_file = shell_argument(stem + ".case.h5");
  const std::string results = shell_argument(stem + ".results");
  std::string text = "suffuse-mesher " + shell_argument(run.scene().path);
  for (const std::string& change : run.scene().overrides) {
    text += " --set " + shell_argument(change);
  }
  return text + " -o " + case_file + "\nsuffuse-solver " + case_file + " -o " + results +
         "\nsuffuse-post report " + results + " -o " + shell_argument(stem + ".html") + "\n";
}

std::string reproduce_html(const ResultsReader& run, const RunRecord& record) {
  std::string versions;
  for (const auto& [program, version] : record.versions) {
    versions.append(versions.empty() ? "" : ", ").append(program).append(" ").append(version);
  }
  std::string text = "<pre>" + html::escaped(commands(run)) + "</pre>\n" +
                     html::element("p", "Made with " + versions + ".");
  if (!record.model.empty()) {
    text += html::element("p", "Digest of mesh and points: " + record.model + ".");
  }
  if (record.info.resumed_at) {
    text += html::element(
        "p", "The run went on from a stop at t = " + number_text(*record.info.resumed_at) + " s.");
  }
  return text;
}

}  // namespace

std::string run_section(const ResultsReader& run, const RunNumbers& numbers, const std::string& id,
                        const ReportProgress& progress) {
  std::string text = heading(id, "model", "Model");
  text += model_html(run, progress) + scene_html(run);
  text += heading(id, "plan", "What ran") + plan_html(numbers.record);
  text += heading(id, "ledger", "Ledger") + ledger_html(run, numbers);
  text += heading(id, "boundaries", "Boundaries") + boundaries_html(run) + history_html(run);
  text += heading(id, "fields", "Fields") + fields_html(run, progress);
  text += heading(id, "safety", "Safety") + safety_html(run, numbers);
  text += heading(id, "reproduce", "How to make it again") + reproduce_html(run, numbers.record);
  return text;
}

std::string shell_argument(const std::string& text) {
  const bool is_plain = !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string("._-/=").find(static_cast<char>(c)) < 5;
  });
  if (is_plain) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace suffuse

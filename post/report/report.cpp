#include "report/report.hpp"

#include <fstream>

#include "common/errors.hpp"
#include "common/pending_file.hpp"
#include "files/number_text.hpp"
#include "report/first_page.hpp"
#include "report/html.hpp"
#include "report/page_files.hpp"  // generated: page_style, page_script
#include "report/report_pictures.hpp"
#include "report/run_numbers.hpp"
#include "report/run_section.hpp"
#include "results/versions.hpp"
#include "values/run_names.hpp"

namespace suffuse {
namespace {

std::string id_of(std::size_t run) {
  return "run" + std::to_string(run + 1);
}

/// A row for each run with its decisive numbers.
std::string runs_table(const std::vector<std::string>& labels,
                       const std::vector<ResultsReader>& runs,
                       const std::vector<RunNumbers>& numbers) {
  const std::string mass = shown_unit("kg", runs.front().dimension());
  html::Table table{"runs",
                    {"run", "status", "until t [s]", "fines lost [" + mass + "]",
                     "fines lost [% of the dry mass]", "least safety [-]", "at [m]", "at t [s]",
                     "largest residual [-]", "warnings"},
                    {}};
  const auto number = [](const std::optional<double>& value) {
    return value ? html::cell(*value) : html::cell("-");
  };
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const RunNumbers& n = numbers[r];
    const LeastSafety* least = n.least_safety_at_exits();
    table.rows.push_back(
        {html::cell(labels[r]), html::cell(runs[r].status()), html::cell(n.end),
         number(n.fines_out), number(n.fines_percent),
         least ? html::cell(least->safety) : html::cell("-"),
         html::cell(least ? place_text(least->place) : "-"),
         least ? html::cell(least->time) : html::cell("-"),
         n.worst ? html::cell(n.worst->worst_residual, short_text(n.worst->worst_residual))
                 : html::cell("-"),
         html::cell(static_cast<double>(n.record.info.warnings.size()))});
  }
  return table.html();
}

std::string contents(const std::vector<std::string>& labels) {
  std::string links = "<nav><a href=\"#curves\">Curves</a>";
  for (std::size_t r = 0; r < labels.size(); ++r) {
    if (labels.size() > 1) {
      links += " <a href=\"#" + id_of(r) + "\">" + html::escaped(labels[r]) + "</a>";
      continue;
    }
    for (const auto& [part, title] :
         std::initializer_list<std::pair<const char*, const char*>>{{"model", "Model"},
                                                                    {"plan", "What ran"},
                                                                    {"ledger", "Ledger"},
                                                                    {"boundaries", "Boundaries"},
                                                                    {"fields", "Fields"},
                                                                    {"safety", "Safety"},
                                                                    {"reproduce", "Reproduce"}}) {
      links += " <a href=\"#" + id_of(r) + "-" + part + "\">" + title + "</a>";
    }
  }
  return links + "</nav>\n";
}

/// The content security policy forbids the page to load anything.
constexpr const char* page_start = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy"
 content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
)";

std::string page(const std::string& title, const std::string& body) {
  const auto made_with = versions();
  return page_start + html::element("title", title) + "<style>\n" + page_style +
         "</style>\n</head>\n<body>\n" + html::element("h1", title) + body +
         html::element("footer", "Written by suffuse-post " + made_with.at("suffuse") + " (" +
                                     made_with.at("git") + ").") +
         "<script>\n" + page_script + "</script>\n</body>\n</html>\n";
}

}  // namespace

std::string report_html(const std::vector<ResultsReader>& runs,
                        const std::vector<std::string>& tables, const ReportProgress& progress) {
  const std::vector<std::string> labels = run_labels(runs);
  const bool several = runs.size() > 1;
  const auto of_run = [&](std::size_t r) -> ReportProgress {
    const std::string start = several ? labels[r] + ": " : "";
    return [&progress, start](const std::string& part) { tell(progress, start + part); };
  };
  std::vector<RunNumbers> numbers;
  std::string title;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    tell(of_run(r), "numbers and checks");
    numbers.push_back(run_numbers(runs[r]));
    title += (r == 0 ? "" : ", ") + labels[r];
  }
  std::string body = several ? runs_table(labels, runs, numbers) : "";
  if (!several) body = first_page(runs[0], numbers[0]);
  for (const std::string& path : tables) body += table_file_html(runs.front(), path);
  body += contents(labels) + "<h2 id=\"curves\">Curves</h2>\n" + curves_html(runs, progress);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    body += "<section class=\"run\" id=\"" + id_of(r) + "\">\n" +
            html::element("h2", several ? labels[r] : "The run");
    if (several) body += first_page(runs[r], numbers[r]);
    body += run_section(runs[r], numbers[r], id_of(r), of_run(r)) + "</section>\n";
  }
  return page(title, body);
}

void write_report(const std::vector<ResultsReader>& runs, const std::string& path,
                  const std::vector<std::string>& tables, const ReportProgress& progress) {
  const std::string page = report_html(runs, tables, progress);
  PendingFile file(path);
  std::ofstream out(file.temporary_path(), std::ios::binary);
  out << page << std::flush;
  if (!out) throw FileError(path + ": could not be written whole; is the disk full?");
  file.commit();
}

}  // namespace suffuse

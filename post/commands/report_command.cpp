/// The subcommand `report`.

#include <filesystem>
#include <iostream>

#include "commands/command.hpp"
#include "report/report.hpp"
#include "values/refusal.hpp"

namespace suffuse {
namespace {

struct ReportOptions {
  std::vector<std::string> results;
  std::string output;
  std::vector<std::string> tables;
  bool quiet = false;
};

void declare_report(CLI::App& command, ReportOptions& o) {
  add_results(command, o.results);
  command.add_option("-o,--output", o.output, "page to write")->required()->type_name("FILE.html");
  command
      .add_option(
          "--table", o.tables,
          "a table to show on the first page, such as factors of safety or critical levels; "
          "repeatable")
      ->type_name("FILE.csv");
  command.add_flag("--quiet", o.quiet, "no progress on standard error");
}

void report(const ReportOptions& o) {
  const std::string suffix = std::filesystem::path(o.output).extension().string();
  if (suffix != ".html" && suffix != ".htm") {
    refuse("suffuse-post report", "-o", '"' + o.output + '"',
           "a name that ends in .html; browsers print it as PDF");
  }
  const auto runs = open_all(o.results);
  for (const auto& run : runs) refuse_inside(run, "-o", o.output);
  const ReportProgress progress = [](const std::string& part) {
    std::cerr << "suffuse-post report: " << part << '\n';
  };
  write_report(runs, o.output, o.tables, o.quiet ? ReportProgress{} : progress);
}

}  // namespace

void add_report_command(Commands& commands) {
  commands.add("report", "A page with summary, tables, curves and fields of one run or several",
               declare_report, report);
}

}  // namespace suffuse

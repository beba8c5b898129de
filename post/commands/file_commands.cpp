/// The subcommands `table` and `export`.

#include "commands/command.hpp"
#include "tables/export.hpp"
#include "tables/run_table.hpp"

namespace suffuse {
namespace {

struct RunTableOptions {
  std::vector<std::string> results;
  std::string csv;
};

void declare_table(CLI::App& command, RunTableOptions& o) {
  add_results(command, o.results);
  command.add_option("--csv", o.csv, "table to write; - is standard output")
      ->required()
      ->type_name("FILE");
}

void table(const RunTableOptions& o) {
  const auto runs = open_all(o.results);
  for (const auto& run : runs) refuse_inside(run, "--csv", o.csv);
  write_run_table(o.csv, runs);
}

struct ExportOptions {
  std::string results;
  std::string output;
};

void declare_export(CLI::App& command, ExportOptions& o) {
  add_results(command, o.results);
  command.add_option("-o,--output", o.output, "folder to write into")
      ->required()
      ->type_name("FOLDER");
}

void export_results(const ExportOptions& o) {
  const ResultsReader results(o.results);
  refuse_inside(results, "-o", o.output);
  export_vtu(results, o.output);
}

}  // namespace

void add_file_commands(Commands& commands) {
  commands.add("table", "One row per run: settings, cost, errors", declare_table, table);
  commands.add("export", ".pvd and .vtu files for other tools", declare_export, export_results);
}

}  // namespace suffuse

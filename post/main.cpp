/// suffuse-post: tables and figures from results folders.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>

#include "boundary_figures.hpp"
#include "case/closest_name.hpp"
#include "case/errors.hpp"
#include "export.hpp"
#include "figures.hpp"
#include "ledger_report.hpp"
#include "picture.hpp"
#include "reference_error.hpp"
#include "render.hpp"
#include "results/number_text.hpp"
#include "results/reader.hpp"
#include "run_curves.hpp"
#include "run_table.hpp"
#include "sample.hpp"
#include "sweep_figures.hpp"

namespace suffuse {
namespace {

struct Options {
  std::string results;
  std::vector<std::string> all_results;
  std::string csv;
  std::string output;
  std::string figure;
  std::string line;
  std::string fields;
  std::string field;
  std::string on;
  std::string range;
  std::string reference;
  std::string measured;
  std::string table;
  std::string x;
  std::vector<std::string> y;
  std::vector<std::string> over_time;
  bool all = false;
  std::optional<double> render_time;
  double tolerance = 1e-12;
  double time = 0.0;
  int count = 0;
};

/// Refuses to write into a results folder: its tables could be overwritten, and the solver deletes
/// the folder when it runs again.
void refuse_inside(const ResultsReader& results, const std::string& option,
                   const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path place = fs::weakly_canonical(fs::absolute(path));
  const fs::path from_results = place.lexically_relative(fs::canonical(results.folder()));
  if (*from_results.begin() == "..") return;
  throw InputError(std::vector{InputProblem{
      "suffuse-post", option, '"' + path + '"',
      "a place outside " + results.folder() + ", which belongs to suffuse-solver", ""}});
}

void write_csv(const ResultsReader& results, const std::string& path, const Table& table) {
  refuse_inside(results, "--csv", path);
  write_table(path, table);
}

void ledger(const Options& options) {
  if (!(options.tolerance >= 0.0)) {
    throw InputError(std::vector{InputProblem{"suffuse-post ledger", "--tolerance",
                                              number_text(options.tolerance),
                                              "a number that is not negative", ""}});
  }
  const ResultsReader results(options.results);
  const auto found = balances(results);
  std::cout << balance_text(results, found);
  if (!options.csv.empty()) write_csv(results, options.csv, results.ledger());
  check_balances(found, options.tolerance);
}

void history(const Options& options) {
  const ResultsReader results(options.results);
  std::cout << history_text(results);
  if (!options.csv.empty()) write_csv(results, options.csv, results.history());
}

void boundaries(const Options& options) {
  const ResultsReader results(options.results);
  std::cout << boundaries_text(results);
  if (options.csv.empty()) return;
  refuse_inside(results, "--csv", options.csv);
  write_tables(options.csv, "boundary", results.boundaries());
}

void sample_line(const Options& options) {
  const SampleLine line = parse_line(options.line);
  const auto fields = parse_field_names(options.fields);
  const ResultsReader results(options.results);
  write_csv(results, options.csv, sample(results, options.time, line, options.count, fields));
}

void error(const Options& options) {
  const auto reference = read_reference_table(options.reference);
  const ResultsReader results(options.results);
  if (!options.csv.empty()) refuse_inside(results, "--csv", options.csv);
  const auto errors = reference_errors(results, reference);
  std::cout << error_text(errors);
  if (!options.csv.empty()) write_errors(options.csv, errors);
}

std::vector<ResultsReader> all_runs(const Options& options) {
  return {options.all_results.begin(), options.all_results.end()};
}

void figure(const Options& options) {
  picture_format(options.output);
  const auto runs = all_runs(options);
  for (const auto& run : runs) refuse_inside(run, "-o", options.output);
  draw_figure(options.figure, runs, options.output, {options.render_time, options.measured});
}

void render_field(const Options& options) {
  const ResultsReader results(options.results);
  RenderRequest request;
  request.field = options.field;
  request.on = options.on;
  request.time = options.render_time;
  request.all = options.all;
  if (!options.range.empty()) request.range = parse_range(options.range);
  request.output =
      options.output.empty() ? folder_name(results) + "-" + options.field + ".png" : options.output;
  refuse_inside(results, "-o", request.output);
  for (const auto& path : render(results, request)) std::cout << path << "\n";
}

void table(const Options& options) {
  const auto runs = all_runs(options);
  for (const auto& run : runs) refuse_inside(run, "--csv", options.csv);
  write_run_table(options.csv, runs);
}

void export_results(const Options& options) {
  const ResultsReader results(options.results);
  refuse_inside(results, "-o", options.output);
  export_vtu(results, options.output);
}

void sweep(const Options& options) {
  picture_format(options.output, "suffuse-post sweep");
  if (options.y.empty() == options.over_time.empty()) {
    throw InputError(
        std::vector{InputProblem{"suffuse-post sweep", "", options.y.empty() ? "neither" : "both",
                                 "--y or --over-time", ""}});
  }
  const SweepTable table = read_sweep(options.table);
  if (options.y.empty()) {
    draw_charts(over_time_charts(table, options.over_time), options.output);
  } else if (options.x.empty()) {
    draw_charts(distribution_charts(table, options.y), options.output);
  } else {
    draw_charts(over_key_charts(table, options.x, options.y), options.output);
  }
}

using Action = std::function<void(const Options&)>;

CLI::App* add_command(CLI::App& app, Action& chosen, const std::string& name,
                      const std::string& sentence, Action action) {
  auto* command = app.add_subcommand(name, sentence);
  command->callback([&chosen, action = std::move(action)] { chosen = action; });
  return command;
}

void add_results(CLI::App* command, Options& o) {
  command->add_option("RESULTS", o.results, "results folder")->required()->type_name("FOLDER");
}

void add_balance_commands(CLI::App& app, Options& o, Action& chosen) {
  auto* command = add_command(app, chosen, "ledger", "Balance of water and grains", ledger);
  add_results(command, o);
  command->add_option("--csv", o.csv, "write the whole ledger here")->type_name("FILE");
  command->add_option("--tolerance", o.tolerance, "largest residual allowed")
      ->capture_default_str();

  command = add_command(app, chosen, "history", "Range of every quantity over the run", history);
  add_results(command, o);
  command->add_option("--csv", o.csv, "write the whole history here")->type_name("FILE");

  command = add_command(app, chosen, "boundaries",
                        "What crossed each boundary: water, fines, discharge", boundaries);
  add_results(command, o);
  command->add_option("--csv", o.csv, "write the rows of all boundaries here")->type_name("FILE");
}

void add_value_commands(CLI::App& app, Options& o, Action& chosen) {
  auto* command =
      add_command(app, chosen, "sample", "Fields along a line at one time", sample_line);
  add_results(command, o);
  command->add_option("--time", o.time, "time, s; between snapshots by interpolation")->required();
  command->add_option("--line", o.line, "its two ends, m")->required()->type_name("X0,Y0:X1,Y1");
  command->add_option("--count", o.count, "points, ends included")->required();
  command->add_option("--fields", o.fields, "fields, with commas between")
      ->required()
      ->type_name("NAME,...");
  command->add_option("--csv", o.csv, "table to write")->required()->type_name("FILE");

  command = add_command(app, chosen, "error", "Distance from values that are known", error);
  add_results(command, o);
  command
      ->add_option("--reference", o.reference,
                   "known values: columns t, x and y or neither, and a column per quantity")
      ->required()
      ->type_name("FILE.csv");
  command->add_option("--csv", o.csv, "write the errors here")->type_name("FILE");
}

void add_picture_commands(CLI::App& app, Options& o, Action& chosen) {
  auto* command =
      add_command(app, chosen, "render", "Pictures of a field on the model", render_field);
  add_results(command, o);
  command->add_option("--field", o.field, "what to show")->required();
  auto* time = command->add_option("--time", o.render_time,
                                   "time, s: the nearest snapshot; without it the last");
  command->add_flag("--all", o.all, "every snapshot, in the same colours: FILE_0000.png, ...")
      ->excludes(time);
  command->add_option("--on", o.on, "where, if the field lives in several places")
      ->type_name("cell|node|solid|liquid");
  command->add_option("--range", o.range, "range of the colours; without it that of the values")
      ->type_name("LO,HI");
  command->add_option("-o,--output", o.output, "picture to write; without it RESULTS-FIELD.png")
      ->type_name("FILE.png");

  command = add_command(app, chosen, "figure", "A figure of one or more runs", figure);
  command->add_option("NAME", o.figure, "one of " + quoted_list(figure_names()))->required();
  command->add_option("RESULTS", o.all_results, "results folders")->required()->type_name("FOLDER");
  command->add_option(
      "--time", o.render_time,
      "of \"head\" and \"saturation\", s: the nearest snapshot; without it the last");
  command
      ->add_option(
          "--measured", o.measured,
          "of \"fines-lost\": points beside the curves; columns run, hours, and fines_lost, "
          "conductance or both")
      ->type_name("FILE.csv");
  command->add_option("-o,--output", o.output, "picture to write: .png, .svg or .pdf")
      ->required()
      ->type_name("FILE");
}

void add_sweep_command(CLI::App& app, Options& o, Action& chosen) {
  auto* command = add_command(app, chosen, "sweep",
                              "A figure of the runs of a sweep, with median and 10 to 90 %", sweep);
  command->add_option("TABLE", o.table, "sweep.csv of make's target sweep; results lie beside it")
      ->required()
      ->type_name("FILE.csv");
  command->add_option("--y", o.y, "columns of the table; without --x their distributions")
      ->delimiter(',')
      ->type_name("COLUMN,...");
  auto* x = command->add_option("--x", o.x, "key or column to draw them over")->type_name("COLUMN");
  command
      ->add_option("--over-time", o.over_time,
                   "columns of history.csv or ledger.csv, to draw against time")
      ->delimiter(',')
      ->excludes(x)
      ->type_name("COLUMN,...");
  command->add_option("-o,--output", o.output, "picture to write: .png, .svg or .pdf")
      ->required()
      ->type_name("FILE");
}

void add_file_commands(CLI::App& app, Options& o, Action& chosen) {
  auto* command =
      add_command(app, chosen, "table", "One row per run: settings, cost, errors", table);
  command->add_option("RESULTS", o.all_results, "results folders")->required()->type_name("FOLDER");
  command->add_option("--csv", o.csv, "table to write")->required()->type_name("FILE");

  command =
      add_command(app, chosen, "export", ".pvd and .vtu files for other tools", export_results);
  add_results(command, o);
  command->add_option("-o,--output", o.output, "folder to write into")
      ->required()
      ->type_name("FOLDER");
}

void declare(CLI::App& app, Options& o, Action& chosen) {
  app.require_subcommand(1);
  add_balance_commands(app, o, chosen);
  add_value_commands(app, o, chosen);
  add_picture_commands(app, o, chosen);
  add_sweep_command(app, o, chosen);
  add_file_commands(app, o, chosen);
}

/// Makes empty values an error. They come from unset variables of scripts.
void refuse_empty_values(CLI::App& app) {
  const CLI::Validator not_empty(
      [](const std::string& value) { return value.empty() ? "expected a value" : ""; }, "");
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() > 0) option->check(not_empty);
    }
  }
}

/// Names a misspelt subcommand, which CLI11 would report as a missing one.
void refuse_unknown_command(const CLI::App& app, const std::string& first) {
  std::vector<std::string> known;
  for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    known.push_back(command->get_name());
  }
  if (first.starts_with("-") || std::ranges::find(known, first) != known.end()) return;
  throw InputError(std::vector{InputProblem{"suffuse-post", "", '"' + first + '"',
                                            quoted_list(known), closest_name(first, known)}});
}

int run(int argc, char** argv) {
  CLI::App app("Tables and figures from the results of suffuse-solver.", "suffuse-post");
  app.set_version_flag("--version", SUFFUSE_VERSION);
  Options options;
  Action chosen;
  declare(app, options, chosen);
  refuse_empty_values(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    if (argc > 1) refuse_unknown_command(app, argv[1]);
    throw InputError(std::string(error.what()) + " (suffuse-post --help lists what there is)");
  }
  chosen(options);
  return static_cast<int>(ExitCode::done);
}

}  // namespace
}  // namespace suffuse

int main(int argc, char** argv) {
  return suffuse::run_program("suffuse-post", [&] { return suffuse::run(argc, argv); });
}

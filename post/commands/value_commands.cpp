/// The subcommands `sample` and `error`.

#include <iostream>

#include "commands/command.hpp"
#include "tables/reference_error.hpp"
#include "values/sample.hpp"

namespace suffuse {
namespace {

struct SampleOptions {
  std::string results;
  double time = 0.0;
  std::string line;
  int count = 0;
  std::string fields;
  std::string csv;
};

void declare_sample(CLI::App& command, SampleOptions& o) {
  add_results(command, o.results);
  command.add_option("--time", o.time, "time, s; between snapshots by interpolation")->required();
  command.add_option("--line", o.line, "its two ends, m")->required()->type_name("X0,Y0:X1,Y1");
  command.add_option("--count", o.count, "points, ends included")->required();
  command.add_option("--fields", o.fields, "fields, with commas between")
      ->required()
      ->type_name("NAME,...");
  command.add_option("--csv", o.csv, "table to write")->required()->type_name("FILE");
}

void sample_line(const SampleOptions& o) {
  const SampleLine line = parse_line(o.line);
  const auto fields = parse_field_names(o.fields);
  const ResultsReader results(o.results);
  write_csv(results, o.csv, sample(results, o.time, line, o.count, fields));
}

struct ErrorOptions {
  std::string results;
  std::string reference;
  std::string csv;
};

void declare_error(CLI::App& command, ErrorOptions& o) {
  add_results(command, o.results);
  command
      .add_option("--reference", o.reference,
                  "known values: columns t, x and y or neither, and a column per quantity")
      ->required()
      ->type_name("FILE.csv");
  command.add_option("--csv", o.csv, "write the errors here")->type_name("FILE");
}

void error(const ErrorOptions& o) {
  const auto reference = read_reference_table(o.reference);
  const ResultsReader results(o.results);
  if (!o.csv.empty()) refuse_inside(results, "--csv", o.csv);
  const auto errors = reference_errors(results, reference);
  std::cout << error_text(errors);
  if (!o.csv.empty()) write_errors(o.csv, errors);
}

}  // namespace

void add_value_commands(Commands& commands) {
  commands.add("sample", "Fields along a line at one time", declare_sample, sample_line);
  commands.add("error", "Distance from values that are known", declare_error, error);
}

}  // namespace suffuse

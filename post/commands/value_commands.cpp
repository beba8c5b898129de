/// The subcommands `sample` and `error`.

#include <iostream>

#include "commands/command.hpp"
#include "files/time_unit.hpp"
#include "tables/reference_error.hpp"
#include "values/sample.hpp"

namespace suffuse {
namespace {

struct SampleOptions {
  std::string results;
  std::string time;
  std::string times;
  std::string line;
  std::string place;
  int count = 101;
  std::string fields;
  bool change = false;
  TableOutput table{"-"};
};

void declare_sample(CLI::App& command, SampleOptions& o) {
  add_results(command, o.results);
  auto* times = command.add_option_group("time")->require_option(1);
  times
      ->add_option("--time", o.time,
                   "time, s or with its unit, as 2.5d; between snapshots by interpolation")
      ->type_name(time_form);
  times->add_option("--times", o.times, "several, with commas between; all: those of the snapshots")
      ->type_name("T,...|all");
  auto* places = command.add_option_group("place")->require_option(1);
  places->add_option("--line", o.line, "along a line, by its two ends, m")
      ->type_name("X0,Y0[,Z0]:X1,Y1[,Z1]");
  places->add_option("--at", o.place, "at a point, m")->type_name("X,Y[,Z]");
  command.add_option("--count", o.count, "points on the line, ends included")
      ->capture_default_str();
  command.add_option("--fields", o.fields, "fields, with commas between")
      ->required()
      ->type_name("NAME,...");
  command.add_flag("--change", o.change, "what changed since the start");
  add_table_options(command, o.table, "table to write");
}

void sample_fields(const SampleOptions& o) {
  SampleRequest request;
  request.positions =
      o.place.empty() ? places_on(parse_line(o.line), o.count) : std::vector{parse_place(o.place)};
  request.fields = parse_field_names(o.fields);
  request.change = o.change;
  SampleNames names;
  if (!o.place.empty()) names.places = "--at";
  if (o.time.empty()) names.time = "--times";
  const ResultsReader results(o.results);
  request.times = o.time.empty() ? parse_times(results, o.times)
                                 : std::vector{parse_time(o.time, names.command)};
  write_csv(results, o.table, sample(results, request, names));
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
                  "known values: columns t, x and y (and z) or neither, and a column per quantity")
      ->required()
      ->type_name("FILE.csv");
  command.add_option("--csv", o.csv, "write the errors here; - is standard output")
      ->type_name("FILE");
}

void error(const ErrorOptions& o) {
  const auto reference = read_reference_table(o.reference);
  const ResultsReader results(o.results);
  if (!o.csv.empty()) refuse_inside(results, "--csv", o.csv);
  const auto errors = reference_errors(results, reference);
  if (o.csv != "-") std::cout << error_text(errors);
  if (!o.csv.empty()) write_errors(o.csv, errors);
}

}  // namespace

void add_value_commands(Commands& commands) {
  commands.add("sample", "Fields along a line or at a point", declare_sample, sample_fields);
  commands.add("error", "Distance from values that are known", declare_error, error);
}

}  // namespace suffuse

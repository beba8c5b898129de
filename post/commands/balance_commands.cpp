/// The subcommands `ledger`, `history`, `boundaries` and `check`.

#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <optional>

#include "checks/checks.hpp"
#include "checks/heave_safety.hpp"
#include "commands/command.hpp"
#include "common/command_line.hpp"
#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "tables/boundary_text.hpp"
#include "tables/discharge_text.hpp"
#include "tables/ledger_report.hpp"
#include "tables/table_output.hpp"

namespace suffuse {
namespace {

struct LedgerOptions {
  std::string results;
  TableOutput table;
  double tolerance = 1e-12;
};

void declare_ledger(CLI::App& command, LedgerOptions& o) {
  add_results(command, o.results);
  add_table_options(command, o.table, "write the whole ledger here");
  command.add_option("--tolerance", o.tolerance, "largest residual allowed")->capture_default_str();
}

void ledger(const LedgerOptions& o) {
  if (!(o.tolerance >= 0.0)) {
    throw InputError(InputProblem{"suffuse-post ledger", "--tolerance", number_text(o.tolerance),
                                  "a number that is not negative"});
  }
  parse_time_unit(o.table.time_unit, "suffuse-post ledger");
  const ResultsReader results(o.results);
  const auto found = balances(results);
  if (o.table.path != "-") std::cout << balance_text(results, found);
  if (!o.table.path.empty()) write_csv(results, o.table, results.ledger());
  check_balances(found, o.tolerance);
  check_stored_water(results);
}

struct TableOptions {
  std::string results;
  TableOutput table;
};

void declare_history(CLI::App& command, TableOptions& o) {
  add_results(command, o.results);
  add_table_options(command, o.table, "write the whole history here");
}

void history(const TableOptions& o) {
  const TimeUnit unit = parse_time_unit(o.table.time_unit, "suffuse-post history");
  const ResultsReader results(o.results);
  if (o.table.path != "-") std::cout << history_text(results, unit);
  if (!o.table.path.empty()) write_csv(results, o.table, results.history());
}

void declare_boundaries(CLI::App& command, TableOptions& o) {
  add_results(command, o.results);
  add_table_options(command, o.table, "write the rows of all boundaries here");
}

void boundaries(const TableOptions& o) {
  const TimeUnit unit = parse_time_unit(o.table.time_unit, "suffuse-post boundaries");
  const ResultsReader results(o.results);
  if (o.table.path != "-") std::cout << boundaries_text(results);
  if (o.table.path.empty()) return;
  refuse_inside(results, "--csv", o.table.path);
  write_tables(o.table.path, "boundary",
               with_units(results.boundaries(), results.dimension(), unit));
}

/// Whether standard output is a terminal that shows colours (no-color.org).
bool shows_colors() {
  const char* refused = std::getenv("NO_COLOR");
  return isatty(STDOUT_FILENO) == 1 && (refused == nullptr || *refused == '\0');
}

struct CheckOptions {
  std::string results;
  std::optional<double> least;
  std::vector<std::string> changes;
  std::string csv;
  std::string time_unit;
  bool fail = false;
};

void declare_check(CLI::App& command, CheckOptions& o) {
  add_results(command, o.results);
  command
      .add_option("--least", o.least,
                  "fail with exit code 3 where a safety i_cr / i against heave is below this")
      ->check(number_in(0.0, 1e9));
  command
      .add_option("--set", o.changes, "change a key of the table [check] of the scene, repeatable")
      ->type_name("check.KEY=VALUE");
  command.add_option("--csv", o.csv, "write the table of all mechanisms here")->type_name("FILE");
  command
      .add_option("--time-unit", o.time_unit,
                  "unit of times; given, it is in the heads of the CSV table too; without it s")
      ->type_name(time_unit_words());
  command.add_flag("--fail", o.fail,
                   "fail with exit code 3 where the factor of a mechanism is below 1");
}

void check(const CheckOptions& o) {
  std::optional<TimeUnit> unit;
  if (!o.time_unit.empty()) unit = parse_time_unit(o.time_unit, "suffuse-post check");
  const ResultsReader results(o.results);
  const CheckReport report = check_run(results, check_settings(results, o.changes));
  for (const std::string& sentence : report.unseen_peaks) {
    std::cerr << "suffuse-post: warning: not looked at: " << sentence << '\n';
  }
  const auto parts = safety_of(results);
  if (o.csv != "-") {
    const TextStyle style{unit.value_or(TimeUnit{}), shows_colors()};
    std::cout << safety_text(results, parts, style) << '\n' << check_text(report, style);
    if (const std::string known = discharge_text(results); !known.empty()) {
      std::cout << known << '\n';
    }
  }
  if (!o.csv.empty()) {
    refuse_inside(results, "--csv", o.csv);
    write_checks(o.csv, report, results.dimension(), unit);
  }
  if (o.least) check_safety(parts, *o.least);
  require_all_checks(report);
  if (o.fail) require_limit_states(report);
}

}  // namespace

void add_balance_commands(Commands& commands) {
  commands.add("ledger", "Balance of water and grains", declare_ledger, ledger);
  commands.add("history", "Range of every quantity over the run", declare_history, history);
  commands.add("boundaries", "What crossed each boundary: water, fines, discharge",
               declare_boundaries, boundaries);
  commands.add("check", "Safety against erosion, heave, uplift, backward erosion; filters",
               declare_check, check);
}

}  // namespace suffuse

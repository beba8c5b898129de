/// The subcommands `ledger`, `history` and `boundaries`.

#include <iostream>

#include "case/errors.hpp"
#include "commands/command.hpp"
#include "results/number_text.hpp"
#include "tables/boundary_text.hpp"
#include "tables/ledger_report.hpp"

namespace suffuse {
namespace {

struct LedgerOptions {
  std::string results;
  std::string csv;
  double tolerance = 1e-12;
};

void declare_ledger(CLI::App& command, LedgerOptions& o) {
  add_results(command, o.results);
  command.add_option("--csv", o.csv, "write the whole ledger here")->type_name("FILE");
  command.add_option("--tolerance", o.tolerance, "largest residual allowed")->capture_default_str();
}

void ledger(const LedgerOptions& o) {
  if (!(o.tolerance >= 0.0)) {
    throw InputError(
        std::vector{InputProblem{"suffuse-post ledger", "--tolerance", number_text(o.tolerance),
                                 "a number that is not negative", ""}});
  }
  const ResultsReader results(o.results);
  const auto found = balances(results);
  std::cout << balance_text(results, found);
  if (!o.csv.empty()) write_csv(results, o.csv, results.ledger());
  check_balances(found, o.tolerance);
}

struct TableOptions {
  std::string results;
  std::string csv;
};

void declare_history(CLI::App& command, TableOptions& o) {
  add_results(command, o.results);
  command.add_option("--csv", o.csv, "write the whole history here")->type_name("FILE");
}

void history(const TableOptions& o) {
  const ResultsReader results(o.results);
  std::cout << history_text(results);
  if (!o.csv.empty()) write_csv(results, o.csv, results.history());
}

void declare_boundaries(CLI::App& command, TableOptions& o) {
  add_results(command, o.results);
  command.add_option("--csv", o.csv, "write the rows of all boundaries here")->type_name("FILE");
}

void boundaries(const TableOptions& o) {
  const ResultsReader results(o.results);
  std::cout << boundaries_text(results);
  if (o.csv.empty()) return;
  refuse_inside(results, "--csv", o.csv);
  write_tables(o.csv, "boundary", results.boundaries());
}

}  // namespace

void add_balance_commands(Commands& commands) {
  commands.add("ledger", "Balance of water and grains", declare_ledger, ledger);
  commands.add("history", "Range of every quantity over the run", declare_history, history);
  commands.add("boundaries", "What crossed each boundary: water, fines, discharge",
               declare_boundaries, boundaries);
}

}  // namespace suffuse

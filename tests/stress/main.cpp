/// suffuse-stress: runs scenes that leave the usual range and judges what comes out.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "common/errors.hpp"
#include "stress/energy.hpp"
#include "stress/judge.hpp"
#include "stress/stress_case.hpp"
#include "stress/sweep_parts.hpp"

namespace {

namespace fs = std::filesystem;
using namespace suffuse;
using namespace suffuse::stress;

struct Arguments {
  std::string solver;
  std::string folder = "stress";
  std::string table;
  std::string sweep;
  std::vector<int> only;  ///< runs by number
  int every = 1;
  double limit = 60.0;  ///< s
  bool list = false;
  bool keep = false;
};

/// Runs the scenario twice: with its strength, and with the scaled strength.
Judgement judged_strength(const Scenario& scenario, const Arguments& arguments,
                          const std::string& stem) {
  std::vector<ChildEnd> ends;
  std::vector<std::string> tables;
  for (const bool scaled : {false, true}) {
    Scenario one = scenario;
    if (scaled) {
      one.changes = [&](const Span& span) {
        return joined(scenario.changes(span), scenario.strength->scaled);
      };
    }
    const std::string path = stem + ".case.h5";
    tables.push_back(stem + (scaled ? ".scaled.csv" : ".csv"));
    try {
      write_case(path, make_case<2>(one));
    } catch (const InputError& error) {
      return judge_refusal(scenario, error.what());
    }
    ends.push_back(
        run_child({arguments.solver, path, "--strength-reduction", "-o", tables.back(), "--quiet"},
                  stem + ".log", arguments.limit));
    if (ends.back().exit_code != 0) break;
  }
  return judge_strength(scenario, ends, tables);
}

template <int Dim>
Judgement judged(const Scenario& scenario, const Arguments& arguments, const std::string& stem) {
  try {
    const Case<Dim> c = make_case<Dim>(scenario);
    const std::string path = stem + ".case.h5";
    const std::string results = stem + ".results";
    write_case(path, c);
    const ChildEnd end = run_child({arguments.solver, path, "-o", results, "--force", "--quiet"},
                                   stem + ".log", arguments.limit);
    return judge_run(scenario, c, end, results);
  } catch (const InputError& error) {
    return judge_refusal(scenario, error.what());
  }
}

void list() {
  for (const Sweep& sweep : all_sweeps()) {
    std::cout << sweep.name << ',' << sweep.what << '\n';
  }
  std::cout << "energy," << energy_sweep_is() << '\n';
}

/// Makes the runs of a sweep, a line of the table each. Returns how many failed.
int run_sweep(const Sweep& sweep, const Arguments& arguments, std::ostream& table) {
  int failed = 0;
  for (std::size_t i = 0; i < sweep.scenarios.size(); ++i) {
    const bool wanted = arguments.only.empty()
                            ? i % arguments.every == 0
                            : std::ranges::count(arguments.only, static_cast<int>(i)) > 0;
    if (!wanted) continue;
    const Scenario& scenario = sweep.scenarios[i];
    const std::string stem =
        (fs::path(arguments.folder) / (sweep.name + "-" + std::to_string(i))).string();
    const bool in_space = std::holds_alternative<std::function<Mesh<3>()>>(scenario.mesh);
    const Judgement judgement = scenario.strength ? judged_strength(scenario, arguments, stem)
                                : in_space        ? judged<3>(scenario, arguments, stem)
                                                  : judged<2>(scenario, arguments, stem);
    table << table_line(sweep.name, scenario, judgement) << std::endl;
    if (judgement.verdict == "failed") {
      ++failed;
      std::cerr << sweep.name << " " << i << " (" << name_of(scenario.scheme) << ", "
                << scenario.parameters << ", seed " << scenario.seed << "): " << judgement.message
                << '\n';
    } else if (!arguments.keep) {
      for (const char* end : {".case.h5", ".results", ".log", ".csv", ".scaled.csv"})
        fs::remove_all(stem + end);
    }
  }
  return failed;
}

int study(const Arguments& arguments) {
  if (arguments.list) {
    list();
    return 0;
  }
  fs::create_directories(arguments.folder);
  std::ofstream file;
  if (!arguments.table.empty()) file.open(arguments.table);
  std::ostream& table = arguments.table.empty() ? std::cout : file;
  if (!table) throw FileError(arguments.table + ": cannot be written");
  table << table_head() << '\n';
  int failed = 0;
  bool found = false;
  for (const Sweep& sweep : all_sweeps()) {
    if (!arguments.sweep.empty() && sweep.name != arguments.sweep) continue;
    found = true;
    failed += run_sweep(sweep, arguments, table);
  }
  if (arguments.sweep.empty() || arguments.sweep == "energy") {
    found = true;
    failed += run_energy_sweep(table);
  }
  if (!found) throw InputError("--sweep: got " + arguments.sweep + "; --list has them");
  return failed > 0 ? 1 : 0;
}

int run(int argc, char** argv) {
  CLI::App app{"Runs scenes that leave the usual range and judges what comes out.",
               "suffuse-stress"};
  Arguments a;
  app.add_option("--solver", a.solver, "suffuse-solver")->type_name("PROGRAM");
  app.add_option("--folder", a.folder, "for cases and results; those that fail stay");
  app.add_option("--table", a.table, "CSV to write [standard output]");
  app.add_option("--sweep", a.sweep, "this one alone");
  app.add_option("--only", a.only, "of its runs these, from 0");
  app.add_option("--every", a.every, "every so many runs of a sweep")->check(CLI::PositiveNumber);
  app.add_option("--limit", a.limit, "seconds for a run")->check(CLI::PositiveNumber);
  app.add_flag("--list", a.list, "name the sweeps");
  app.add_flag("--keep", a.keep, "keep cases and results of all runs");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : static_cast<int>(ExitCode::wrong_input);
  }
  if (a.solver.empty() && !a.list)
    throw InputError("--solver: got nothing; expected suffuse-solver");
  return study(a);
}

}  // namespace

int main(int argc, char** argv) {
  return suffuse::run_program("suffuse-stress", [&] { return run(argc, argv); });
}

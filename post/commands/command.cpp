#include "commands/command.hpp"

#include <filesystem>

#include "common/errors.hpp"
#include "tables/table_output.hpp"

namespace suffuse {

void add_results(CLI::App& command, std::string& folder) {
  command.add_option("RESULTS", folder, "results folder")->required()->type_name("FOLDER");
}

void add_results(CLI::App& command, std::vector<std::string>& folders) {
  command.add_option("RESULTS", folders, "results folders")->required()->type_name("FOLDER");
}

std::vector<ResultsReader> open_all(const std::vector<std::string>& folders) {
  return {folders.begin(), folders.end()};
}

void refuse_inside(const ResultsReader& results, const std::string& option,
                   const std::string& path) {
  namespace fs = std::filesystem;
  if (path == "-") return;
  const fs::path place = fs::weakly_canonical(fs::absolute(path));
  const fs::path from_results = place.lexically_relative(fs::canonical(results.folder()));
  if (*from_results.begin() == "..") return;
  throw InputError(
      InputProblem{"suffuse-post", option, '"' + path + '"',
                   "a place outside " + results.folder() + ", which belongs to suffuse-solver"});
}

void add_table_options(CLI::App& command, TableOutput& output, const std::string& what) {
  command.add_option("--csv", output.path, what + "; - is standard output")->type_name("FILE");
  command.add_option("--time-unit", output.time_unit, "unit of times in the table")
      ->capture_default_str()
      ->type_name(time_unit_words());
}

void write_csv(const ResultsReader& results, const TableOutput& output, const Table& table) {
  const TimeUnit unit = parse_time_unit(output.time_unit, "suffuse-post");
  refuse_inside(results, "--csv", output.path);
  write_table(output.path, with_units(table, results.dimension(), unit));
}

}  // namespace suffuse

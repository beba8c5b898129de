#include "commands/command.hpp"

#include <filesystem>

#include "case/errors.hpp"

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

}  // namespace suffuse

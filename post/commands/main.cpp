/// suffuse-post: tables and figures from results folders.

#include <CLI/CLI.hpp>
#include <algorithm>

#include "case/closest_name.hpp"
#include "case/errors.hpp"
#include "commands/command.hpp"

namespace suffuse {
namespace {

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
  app.require_subcommand(1);
  Commands commands(app);
  add_balance_commands(commands);
  add_value_commands(commands);
  add_picture_commands(commands);
  add_sweep_command(commands);
  add_file_commands(commands);
  refuse_empty_values(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    if (argc > 1) refuse_unknown_command(app, argv[1]);
    throw InputError(std::string(error.what()) + " (suffuse-post --help lists what there is)");
  }
  commands.run();
  return static_cast<int>(ExitCode::done);
}

}  // namespace
}  // namespace suffuse

int main(int argc, char** argv) {
  return suffuse::run_program("suffuse-post", [&] { return suffuse::run(argc, argv); });
}

/// suffuse-post: tables and figures from results folders.

#include "commands/command.hpp"
#include "common/command_line.hpp"

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

int run(int argc, char** argv) {
  CLI::App app("Tables and figures from the results of suffuse-solver.", "suffuse-post");
  app.footer(exit_codes_help);
  app.set_version_flag("--version", SUFFUSE_VERSION);
  app.require_subcommand(1);
  Commands commands(app);
  add_balance_commands(commands);
  add_value_commands(commands);
  add_picture_commands(commands);
  add_sweep_command(commands);
  add_file_commands(commands);
  add_report_command(commands);
  refuse_empty_values(app);
  if (const auto code = parse_command_line(app, argc, argv)) return *code;
  commands.run();
  return static_cast<int>(ExitCode::done);
}

}  // namespace
}  // namespace suffuse

int main(int argc, char** argv) {
  return suffuse::run_program("suffuse-post", [&] { return suffuse::run(argc, argv); });
}
